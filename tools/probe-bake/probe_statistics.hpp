// Probe statistics: what the maps of one probe say in a few figures.
#pragma once

#include <optional>
#include <pfvox/pf_probe.hpp>
#include <string>

#include "common/json.hpp"

namespace pfvox::tools {

/// Means are over solid angle. Figures of maps that are not there, or of which no texel counts, are empty.
struct ProbeStatistics {
    std::optional<double> missFraction;      ///< of all directions
    std::optional<glm::dvec3> meanIndirect;  ///< I over the directions that meet a surface
    std::optional<double> maxIndirect;       ///< largest channel of any texel
    std::optional<double> minDepthMetres;
    std::optional<double> meanDepthMetres;  ///< over the directions that meet a surface
};

/// `data` fits the resolution of `info`.
ProbeStatistics statisticsOf(const ProbeFieldInfo& info, const ProbeData& data);

/// "9 active, 2 of them relocated; 1 inactive": the words for it in all reports.
std::string countsText(const ProbeCounts& counts);
Json countsJson(const ProbeCounts& counts);  ///< the same as an object

/// "1.25 %", or "unknown".
std::string percentText(const std::optional<double>& fraction);
Json orNull(const std::optional<double>& value);  ///< null where it is unknown

}  // namespace pfvox::tools
