// What the layers have in common: directions and solid angles in double precision, sums over blocks of
// texels, bilinear footprints across the folds of the map.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace pfvox::probe {

glm::dvec3 directionOf(double x, double y, std::uint32_t edge);  ///< of a point of the map, in texels
double solidAngleOf(std::uint32_t x, std::uint32_t y, std::uint32_t edge);

/// Texels along a block so that a map of `edge` has at most `maxBlocks` blocks along an edge; 1 where that is
/// impossible without making them much fewer.
std::uint32_t blockEdgeOf(std::uint32_t edge, std::uint32_t maxBlocks);

/// Directions of the centers of edge * edge texels.
std::vector<glm::dvec3> texelDirections(std::uint32_t edge);

/// The four interior texels of a bilinear lookup and their weights; a texel may occur twice.
struct Footprint {
    std::array<std::uint32_t, 4> texel;
    std::array<double, 4> weight;
};
Footprint footprintOf(glm::dvec3 direction, std::uint32_t interior);

/// Interior words with the border around them.
std::vector<std::uint32_t> withBorder(const std::vector<std::uint32_t>& words, std::uint32_t interior);

}  // namespace pfvox::probe
