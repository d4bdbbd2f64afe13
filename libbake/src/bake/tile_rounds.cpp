#include "bake/tile_rounds.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pfvox::bake {

double relativeError(const shared::TileStatistics& tile, const TileRules& rules) {
    if (tile.batches < 2 || tile.surfaceTexels == 0) return std::numeric_limits<double>::infinity();
    const double count = tile.surfaceTexels;
    const double mean = static_cast<double>(tile.mean) / count;
    return std::sqrt(static_cast<double>(tile.squaredError)) / count / std::max(mean, rules.noiseFloor);
}

std::uint32_t moreBatches(const shared::TileStatistics& tile, const TileRules& rules) {
    if (tile.surfaceTexels == 0 || tile.batches >= rules.maxBatches) return 0;
    if (tile.batches == 0) return std::min(rules.minBatches, rules.maxBatches);
    const bool quiet = rules.noiseTarget <= 0.0 || relativeError(tile, rules) <= rules.noiseTarget;
    if (quiet) return 0;
    return std::min(std::max(1u, tile.batches / 2), rules.maxBatches - tile.batches);
}

TileSummary summaryOf(std::span<const shared::TileStatistics> tiles, const TileRules& rules) {
    TileSummary summary;
    double withSurface = 0.0;
    double judged = 0.0;
    double errors = 0.0;
    for (const shared::TileStatistics& tile : tiles) {
        if (tile.surfaceTexels == 0) continue;
        withSurface += 1.0;
        summary.surfaceTexels += tile.surfaceTexels;
        summary.samples += std::uint64_t{tile.batches} * shared::kBatchSamples * tile.surfaceTexels;
        const double error = relativeError(tile, rules);
        const bool atEnd = tile.batches >= rules.maxBatches;
        if (rules.noiseTarget > 0.0 && atEnd && error > rules.noiseTarget) summary.noisyTileFraction += 1.0;
        if (tile.batches < 2) continue;
        judged += 1.0;
        errors += error;
    }
    if (judged > 0.0) summary.meanError = errors / judged;
    if (withSurface > 0.0) summary.noisyTileFraction /= withSurface;
    return summary;
}

}  // namespace pfvox::bake
