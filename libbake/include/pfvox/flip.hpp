// FLIP: how different two pictures look when one alternates between them (Andersson et al. 2020, "FLIP: A
// Difference Evaluator for Alternating Images"), for pictures of low dynamic range.
//
// Pictures are linear RGB in [0, 1], rows from the top. Pure functions in double precision.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace pfvox {
/// Two pictures to compare, row by row.
struct FlipInput {
    std::uint32_t width = 0;   ///< pixels
    std::uint32_t height = 0;  ///< pixels
    std::span<const glm::vec3> reference;
    std::span<const glm::vec3> test;  ///< width * height, as `reference`
    /// Pixels a degree of the eye's view: 67 for a screen of 3840 pixels on 0.7 m, seen from 0.7 m.
    double pixelsPerDegree = 67.0206;
};

/// For each pixel from 0, the same, to 1.
std::vector<float> flipOf(const FlipInput& input);

}  // namespace pfvox
