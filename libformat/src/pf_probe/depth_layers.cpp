// Layers made from distances: moments and the min map; and light at a lower resolution, which needs to know
// the misses.
#include <algorithm>
#include <pfvox/assert.hpp>
#include <pfvox/probe_layers.hpp>

#include "pf_probe/layer_maths.hpp"
#include "shared/probe_maths.glsl.h"

namespace pfvox {

namespace {

/// The lobe has half its height 9.5 degrees off its axis, and a block is 2.2 degrees wide at most.
constexpr std::uint32_t kMaxMomentBlocks = 128;

double lobe(double cosine) {
    if (cosine <= 0) return 0;
    const double squared = cosine * cosine;
    const double to4 = squared * squared;
    const double to8 = to4 * to4;
    const double to16 = to8 * to8;
    return to16 * to16 * to16 * squared;  // 50 = 16 + 16 + 16 + 2
}

struct DistanceSums {
    std::vector<glm::dvec3> directions;
    std::vector<glm::dvec3> sums;  ///< solid angle, and solid angle times d and d^2
};

DistanceSums sumDistances(const DistanceMap& map, double range) {
    const std::uint32_t block = probe::blockEdgeOf(map.edge, kMaxMomentBlocks);
    const std::uint32_t edge = map.edge / block;
    DistanceSums result{.directions = probe::texelDirections(edge), .sums = {}};
    result.sums.resize(result.directions.size());
    for (std::uint32_t y = 0; y < map.edge; ++y)
        for (std::uint32_t x = 0; x < map.edge; ++x) {
            const double d =
                std::clamp(static_cast<double>(map.texels[x + std::size_t{map.edge} * y]) / range, 0.0, 1.0);
            result.sums[x / block + std::size_t{edge} * (y / block)] +=
                probe::solidAngleOf(x, y, map.edge) * glm::dvec3{1, d, d * d};
        }
    return result;
}

}  // namespace

std::vector<std::uint32_t> momentsLayer(const DistanceMap& distances, float momentRange,
                                        std::uint32_t interior) {
    PFVOX_ASSERT(distances.texels.size() == std::size_t{distances.edge} * distances.edge);
    const DistanceSums blocks = sumDistances(distances, static_cast<double>(momentRange));
    std::vector<std::uint32_t> words;
    for (const glm::dvec3 direction : probe::texelDirections(interior)) {
        glm::dvec3 sum{0};
        for (std::size_t i = 0; i < blocks.sums.size(); ++i)
            sum += lobe(glm::dot(blocks.directions[i], direction)) * blocks.sums[i];
        words.push_back(sum.x > 0 ? shared::packMoments(glm::vec2{glm::dvec2{sum.y, sum.z} / sum.x}) : 0u);
    }
    return probe::withBorder(words, interior);
}

glm::vec2 lookupMoments(std::span<const std::uint32_t> words, std::uint32_t interior, glm::vec3 direction) {
    const probe::Footprint f = probe::footprintOf(glm::dvec3{direction}, interior);
    glm::dvec2 sum{0};
    for (std::size_t k = 0; k < 4; ++k) {
        const std::uint32_t x = f.texel[k] % interior + 1;
        const std::uint32_t y = f.texel[k] / interior + 1;
        sum += f.weight[k] * glm::dvec2(shared::unpackMoments(words[x + (interior + 2) * y]));
    }
    return glm::vec2{sum};
}

std::vector<std::uint16_t> minDepthLayer(std::span<const std::uint32_t> depthNormal, std::uint32_t edge) {
    PFVOX_ASSERT(edge % shared::kMinDepthBlock == 0 && depthNormal.size() == std::size_t{edge} * edge);
    const std::uint32_t blocks = edge / shared::kMinDepthBlock;
    std::vector<std::uint16_t> smallest(std::size_t{blocks} * blocks,
                                        static_cast<std::uint16_t>(shared::kDepthMiss));
    for (std::uint32_t y = 0; y < edge; ++y)
        for (std::uint32_t x = 0; x < edge; ++x) {
            std::uint16_t& block =
                smallest[x / shared::kMinDepthBlock + std::size_t{blocks} * (y / shared::kMinDepthBlock)];
            const std::uint32_t code = shared::depthCodeOf(depthNormal[x + std::size_t{edge} * y]);
            block = std::min(block, static_cast<std::uint16_t>(code));
        }
    return smallest;
}

std::vector<std::uint32_t> lightLayer(const RadianceMap& light, std::span<const std::uint32_t> depthNormal,
                                      std::uint32_t edge) {
    PFVOX_ASSERT(edge != 0 && light.edge % edge == 0 && depthNormal.size() == light.texels.size());
    const std::uint32_t block = light.edge / edge;
    std::vector<glm::dvec3> sums(std::size_t{edge} * edge);
    std::vector<double> weights(sums.size());
    for (std::uint32_t y = 0; y < light.edge; ++y)
        for (std::uint32_t x = 0; x < light.edge; ++x) {
            const std::size_t from = x + std::size_t{light.edge} * y;
            if (shared::isMiss(depthNormal[from])) continue;
            const std::size_t to = x / block + std::size_t{edge} * (y / block);
            const double weight = probe::solidAngleOf(x, y, light.edge);
            sums[to] += weight * glm::dvec3(light.texels[from]);
            weights[to] += weight;
        }
    std::vector<std::uint32_t> words;
    for (std::size_t i = 0; i < sums.size(); ++i)
        words.push_back(weights[i] > 0 ? shared::packLight(glm::vec3{sums[i] / weights[i]}) : 0u);
    return words;
}

}  // namespace pfvox
