// Compare fields: how far two PF_PROBE files of one grid and resolution are apart, probe by probe.
#pragma once

#include <filesystem>
#include <optional>
#include <pfvox/probe_file.hpp>
#include <string>
#include <vector>

namespace pfvox::tools {

/// Differences of one layer over all probes that both files have active.
struct LayerDifference {
    ProbeLayer layer = ProbeLayer::DepthNormal;
    std::uint64_t words = 0;
    std::uint64_t differentWords = 0;
    double largest = 0.0;               ///< depth codes, light (largest channel), moments
    std::uint32_t largestProbe = kNoProbe;
    double withinOneShare = 1.0;        ///< of depth codes: at most one apart
    double largestNormalDegrees = 0.0;  ///< of DepthNormal
    std::optional<double> psnrDecibel;  ///< of light, against the largest value of the first file; none = equal
};

struct FieldDifference {
    std::uint32_t probes = 0;
    std::uint32_t equalProbes = 0;                  ///< equal hashes
    std::vector<std::uint32_t> differentRecords;    ///< state or place
    std::vector<std::string> differentSettings;     ///< of the header: seed, device, ...
    std::vector<LayerDifference> layers;
    bool equal() const { return equalProbes == probes; }
};

/// Errors: those of ProbeFileReader; BadStructure when grids, ranges or resolutions differ.
Result<FieldDifference> compareFields(const ProbeFileReader& first, const ProbeFileReader& second);

}  // namespace pfvox::tools
