#include "pf_probe/layer_maths.hpp"

#include <algorithm>
#include <cmath>

#include "shared/probe_maths.glsl.h"

namespace pfvox::probe {

namespace {

double signNotZero(double x) {
    return x >= 0 ? 1 : -1;
}

/// The point of the octahedron, as shared::octUnfold.
glm::dvec3 unfold(double x, double y, std::uint32_t edge) {
    const double u = 2 * x / edge - 1;
    const double v = 2 * y / edge - 1;
    const double z = 1 - std::abs(u) - std::abs(v);
    if (z >= 0) return {u, v, z};
    return {(1 - std::abs(v)) * signNotZero(u), (1 - std::abs(u)) * signNotZero(v), z};
}

/// Where a direction lies, in texels, as shared::texelCoordinate.
glm::dvec2 coordinateOf(glm::dvec3 d, std::uint32_t edge) {
    const double sum = std::abs(d.x) + std::abs(d.y) + std::abs(d.z);
    glm::dvec2 o{d.x / sum, d.y / sum};
    if (d.z < 0) o = {(1 - std::abs(o.y)) * signNotZero(o.x), (1 - std::abs(o.x)) * signNotZero(o.y)};
    return (o * 0.5 + 0.5) * static_cast<double>(edge);
}

}  // namespace

glm::dvec3 directionOf(double x, double y, std::uint32_t edge) {
    return glm::normalize(unfold(x, y, edge));
}

double solidAngleOf(std::uint32_t x, std::uint32_t y, std::uint32_t edge) {
    const glm::dvec3 p = unfold(x + 0.5, y + 0.5, edge);
    const double squared = glm::dot(p, p);
    return 4.0 / (double{1} * edge * edge * squared * std::sqrt(squared));
}

std::uint32_t blockEdgeOf(std::uint32_t edge, std::uint32_t maxBlocks) {
    for (std::uint32_t block = 1; edge / block >= std::max(1u, maxBlocks / 4); ++block)
        if (edge % block == 0 && edge / block <= maxBlocks) return block;
    return 1;
}

std::vector<glm::dvec3> texelDirections(std::uint32_t edge) {
    std::vector<glm::dvec3> directions;
    directions.reserve(std::size_t{edge} * edge);
    for (std::uint32_t y = 0; y < edge; ++y)
        for (std::uint32_t x = 0; x < edge; ++x) directions.push_back(directionOf(x + 0.5, y + 0.5, edge));
    return directions;
}

Footprint footprintOf(glm::dvec3 direction, std::uint32_t interior) {
    // In texels of the map with border, whose texel (1, 1) is the first interior one.
    const glm::dvec2 t = coordinateOf(direction, interior) + 0.5;
    const glm::dvec2 low =
        glm::clamp(glm::floor(t), glm::dvec2{0}, glm::dvec2{static_cast<double>(interior)});
    const glm::dvec2 part = t - low;
    const glm::ivec2 first{low};
    Footprint footprint{};
    for (int k = 0; k < 4; ++k) {
        const glm::ivec2 source =
            shared::borderSource(first + glm::ivec2{k & 1, k >> 1}, static_cast<int>(interior));
        const auto slot = static_cast<std::size_t>(k);
        footprint.texel[slot] =
            static_cast<std::uint32_t>(source.x) + interior * static_cast<std::uint32_t>(source.y);
        footprint.weight[slot] = ((k & 1) != 0 ? part.x : 1 - part.x) * ((k >> 1) != 0 ? part.y : 1 - part.y);
    }
    return footprint;
}

std::vector<std::uint32_t> withBorder(const std::vector<std::uint32_t>& words, std::uint32_t interior) {
    const int n = static_cast<int>(interior);
    std::vector<std::uint32_t> bordered;
    bordered.reserve((std::size_t{interior} + 2) * (interior + 2));
    for (int y = 0; y < n + 2; ++y)
        for (int x = 0; x < n + 2; ++x) {
            const glm::ivec2 source = shared::borderSource({x, y}, n);
            bordered.push_back(words[static_cast<std::size_t>(source.x + n * source.y)]);
        }
    return bordered;
}

}  // namespace pfvox::probe
