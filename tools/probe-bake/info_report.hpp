// Info report: what probe-bake info tells about a PF_PROBE file, for people and as JSON
// (docs/schema/probe-info.schema.json).
#pragma once

#include <filesystem>
#include <pfvox/probe_file.hpp>
#include <string>
#include <vector>

#include "common/json.hpp"
#include "common/reporter.hpp"
#include "probe-bake/probe_statistics.hpp"

namespace pfvox::tools {

struct LayerSize {
    ProbeLayer layer = ProbeLayer::DepthNormal;
    std::uint64_t storedBytes = 0;
    std::uint64_t rawBytes = 0;
};

/// A PF_PROBE file with everything that is counted about it.
struct ProbeFileInfo {
    std::filesystem::path file;
    ProbeFieldInfo field;
    ContentKey contentKey;
    std::uint16_t versionMinor = 0;
    std::uint64_t fileBytes = 0;
    std::optional<glm::uvec3> proximityCounts;
    std::uint64_t coveredCells = 0;  ///< of the proximity grid: name a probe
    std::optional<FaceLightInfo> faces;
    std::vector<LayerSize> layers;      ///< those that the file has
    std::vector<ProbeRecord> records;   ///< of field.range
    std::vector<glm::dvec3> positions;  ///< in the world, metres
    std::vector<ProbeStatistics> probes;
};

/// Reads every map. Errors: those of ProbeFileReader.
Result<ProbeFileInfo> readProbeFileInfo(const std::filesystem::path& file, const Limits& limits,
                                        Diagnostics& diagnostics);

/// Tables, each ended by a newline. `complete`: every probe instead of the first few.
std::string infoText(const ProbeFileInfo& info, const Reporter& reporter, bool complete);

Json infoJson(const ProbeFileInfo& info);

}  // namespace pfvox::tools
