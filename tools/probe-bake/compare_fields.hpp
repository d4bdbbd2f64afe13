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
    double largest = 0.0;  ///< depth codes, light (largest channel), moments
    std::uint32_t largestProbe = kNoProbe;
    std::optional<double>
        withinOneFraction;  ///< of depth codes: at most one apart; nothing = no words, or not depth
    double largestNormalDegrees = 0.0;  ///< of DepthNormal
    /// Of light, against the largest value of the first file, of the second where the first is dark; nothing
    /// = equal, no words, or not light.
    std::optional<double> psnrDecibel;
};

struct FieldDifference {
    std::uint32_t probes = 0;
    std::uint32_t equalProbes = 0;                ///< equal hashes
    std::vector<std::uint32_t> differentRecords;  ///< state or place
    std::vector<std::string> differentSettings;   ///< "--seed 1 and --seed 2", "another scene"
    std::vector<LayerDifference> layers;
    bool equal() const { return equalProbes == probes; }
};

/// Errors: those of ProbeFileReader; BadStructure when grids, ranges or resolutions differ.
Result<FieldDifference> compareFields(const ProbeFileReader& first, const ProbeFileReader& second);

}  // namespace pfvox::tools
