#include "bake/tile_sums.hpp"

#include <algorithm>
#include <cmath>

namespace pfvox::bake {

TileSums::TileSums(std::uint32_t edge, const std::vector<bool>& seesSurface, const TileRules& rules)
    : edge_(edge), rules_(rules), seesSurface_(seesSurface), texels_(seesSurface.size()) {
    tiles_.resize(seesSurface.size() / shared::kTileTexels);
    for (std::uint32_t tile = 0; tile < tiles_.size(); ++tile)
        for (std::uint32_t lane = 0; lane < shared::kTileTexels; ++lane)
            tiles_[tile].surfaceTexels += seesSurface_[texelOf(tile, lane)] ? 1u : 0u;
}

std::size_t TileSums::texelOf(std::uint32_t tile, std::uint32_t lane) const {
    const std::uint32_t perRow = edge_ / shared::kTileEdge;
    const std::uint32_t x = tile % perRow * shared::kTileEdge + lane % shared::kTileEdge;
    const std::uint32_t y = tile / perRow * shared::kTileEdge + lane / shared::kTileEdge;
    return x + std::size_t{edge_} * y;
}

std::vector<LightItem> TileSums::nextRound() {
    std::vector<LightItem> items;
    for (std::uint32_t i = 0; i < tiles_.size(); ++i) {
        Tile& tile = tiles_[i];
        if (tile.surfaceTexels == 0 || tile.quiet || tile.batches >= rules_.maxBatches) continue;
        if (tile.batches != 0) {
            tile.quiet = rules_.noiseTarget <= 0.0 || errorOf(i) <= rules_.noiseTarget;
            if (tile.quiet) continue;
        }
        const std::uint32_t more = tile.batches == 0 ? rules_.minBatches : std::max(1u, tile.batches / 2);
        const std::uint32_t end = std::min(tile.batches + more, rules_.maxBatches);
        for (std::uint32_t batch = tile.batches; batch < end; ++batch) items.push_back({i, batch});
        tile.batches = end;
    }
    return items;
}

void TileSums::add(const LightItem& item, std::span<const glm::vec4> sums) {
    for (std::uint32_t lane = 0; lane < shared::kTileTexels; ++lane) {
        Texel& texel = texels_[texelOf(item.tile, lane)];
        const glm::dvec3 sum(sums[lane]);
        const double mean = (sum.x + sum.y + sum.z) / (3.0 * shared::kBatchSamples);
        texel.sum += sum;
        texel.batchSum += mean;
        texel.batchSquares += mean * mean;
    }
}

double TileSums::squaredErrorOf(const Texel& texel, double batches) {
    const double mean = texel.batchSum / batches;
    return std::max(texel.batchSquares / batches - mean * mean, 0.0) / (batches - 1.0);
}

std::vector<double> TileSums::texelErrors() const {
    std::vector<double> errors(texels_.size());
    for (std::uint32_t tile = 0; tile < tiles_.size(); ++tile) {
        if (tiles_[tile].batches < 2) continue;
        for (std::uint32_t lane = 0; lane < shared::kTileTexels; ++lane) {
            const std::size_t index = texelOf(tile, lane);
            if (seesSurface_[index]) errors[index] = std::sqrt(squaredErrorOf(texels_[index], tiles_[tile].batches));
        }
    }
    return errors;
}

double TileSums::errorOf(std::uint32_t tile) const {
    const double batches = tiles_[tile].batches;
    if (batches < 2.0) return std::numeric_limits<double>::infinity();
    double variance = 0.0;
    double sum = 0.0;
    for (std::uint32_t lane = 0; lane < shared::kTileTexels; ++lane) {
        const std::size_t index = texelOf(tile, lane);
        if (!seesSurface_[index]) continue;
        const Texel& texel = texels_[index];
        sum += texel.batchSum / batches;
        variance += squaredErrorOf(texel, batches);
    }
    const double count = tiles_[tile].surfaceTexels;
    return std::sqrt(variance) / count / std::max(sum / count, rules_.noiseFloor);
}

std::vector<glm::vec3> TileSums::means() const {
    std::vector<glm::vec3> means(texels_.size());
    for (std::uint32_t tile = 0; tile < tiles_.size(); ++tile) {
        const double samples = double{1} * tiles_[tile].batches * shared::kBatchSamples;
        if (samples == 0.0) continue;
        for (std::uint32_t lane = 0; lane < shared::kTileTexels; ++lane) {
            const std::size_t index = texelOf(tile, lane);
            if (seesSurface_[index]) means[index] = glm::vec3(texels_[index].sum / samples);
        }
    }
    return means;
}

double TileSums::meanError() const {
    double sum = 0.0;
    double count = 0.0;
    for (std::uint32_t tile = 0; tile < tiles_.size(); ++tile) {
        if (tiles_[tile].surfaceTexels == 0 || tiles_[tile].batches < 2) continue;
        sum += errorOf(tile);
        count += 1.0;
    }
    return count > 0.0 ? sum / count : 0.0;
}

double TileSums::cappedTileShare() const {
    double capped = 0.0;
    double count = 0.0;
    for (std::uint32_t tile = 0; tile < tiles_.size(); ++tile) {
        if (tiles_[tile].surfaceTexels == 0) continue;
        count += 1.0;
        const bool atEnd = tiles_[tile].batches >= rules_.maxBatches;
        if (rules_.noiseTarget > 0.0 && atEnd && errorOf(tile) > rules_.noiseTarget) capped += 1.0;
    }
    return count > 0.0 ? capped / count : 0.0;
}

std::uint64_t TileSums::samples() const {
    std::uint64_t sum = 0;
    for (const Tile& tile : tiles_)
        sum += std::uint64_t{tile.batches} * shared::kBatchSamples * tile.surfaceTexels;
    return sum;
}

std::uint64_t TileSums::surfaceTexels() const {
    std::uint64_t sum = 0;
    for (const Tile& tile : tiles_) sum += tile.surfaceTexels;
    return sum;
}

}  // namespace pfvox::bake
