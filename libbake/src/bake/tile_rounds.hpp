// Which tiles of a light map need more paths, and how good they are. Pure functions of what the device says
// of each tile, so that nothing depends on how its work was cut.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "shared/bake.glsl.h"

namespace pfvox::bake {

struct TileRules {
    std::uint32_t minBatches = 2;
    std::uint32_t maxBatches = 256;
    double noiseTarget = 0.0;  ///< 0 = minBatches and no more
    double noiseFloor = 0.01;  ///< radiance
};

/// Standard error of the tile's mean over max(mean, noiseFloor), from the spread of its texels' batches;
/// infinity before the second batch.
double relativeError(const shared::TileStatistics& tile, const TileRules& rules);

/// Batches that a tile gets in the next round: minBatches at first, then half as many again as it has until
/// it is quiet or has maxBatches. 0 = done.
std::uint32_t moreBatches(const shared::TileStatistics& tile, const TileRules& rules);

/// What became of all tiles of a map.
struct TileSummary {
    std::optional<double>
        meanError;  ///< relative, over those with a surface and two batches; nothing = there is none
    double noisyTileFraction =
        0.0;                    ///< of those with a surface: stopped at maxBatches before they were quiet
    std::uint64_t samples = 0;  ///< over all texels that see a surface
    std::uint64_t surfaceTexels = 0;
};
TileSummary summaryOf(std::span<const shared::TileStatistics> tiles, const TileRules& rules);

}  // namespace pfvox::bake
