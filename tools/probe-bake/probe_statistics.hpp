// Probe statistics: what the maps of one probe say in a few figures.
#pragma once

#include <optional>
#include <pfvox/pf_probe.hpp>

namespace pfvox::tools {

/// Means are over solid angle. Figures of maps that are not there, or of which no texel counts, are empty.
struct ProbeStatistics {
    std::optional<double> missShare;          ///< of all directions
    std::optional<glm::dvec3> meanIndirect;   ///< I over the directions that meet a surface
    std::optional<double> maxIndirect;        ///< largest channel of any texel
    std::optional<double> minDepthMetres;
    std::optional<double> meanDepthMetres;    ///< over the directions that meet a surface
};

/// `data` fits the resolution of `info`.
ProbeStatistics statisticsOf(const ProbeFieldInfo& info, const ProbeData& data);

}  // namespace pfvox::tools
