// The small layers of a probe, made from what was traced at full resolution: reference for the GPU's
// reductions, and the way where there is no GPU.
//
//     traced radiance -> irradianceLayer;  traced distances -> momentsLayer
//     packed depth -> minDepthLayer;       traced light -> lightLayer at a lower resolution
//
// All maps are octahedral, row by row. Radiance is linear RGB; distances are metres along the texel's
// direction, infinity where it meets nothing. Pure functions in double precision: equal input gives equal
// words.
#pragma once

#include <pfvox/pf_probe.hpp>

namespace pfvox {

/// What leaves the surfaces that the texels see towards the probe, emission + albedo * (E_direct / pi + I),
/// and the sky's radiance where they see none. Holds edge * edge values.
struct RadianceMap {
    std::uint32_t edge = 0;             ///< texels along each side
    std::span<const glm::vec3> texels;  ///< edge * edge, row by row
};
/// Distances by direction, octahedral.
struct DistanceMap {
    std::uint32_t edge = 0;         ///< texels along each side
    std::span<const float> texels;  ///< edge * edge, metres
};

/// ProbeLayer::Irradiance: E / pi for each normal, by quadrature over all texels with their solid angles. The
/// words are not samples of E / pi: they are fitted so that the *bilinear lookup* comes nearest to it over
/// the sphere (least squares; a texel that would be negative is 0, and the others are fitted again).
/// `interior` >= 1 texels, stored with their border. Preconditions: texels are finite and >= 0.
std::vector<std::uint32_t> irradianceLayer(const RadianceMap& radiance, std::uint32_t interior);

/// ProbeLayer::Moments: for each direction the mean and the mean square of min(distance / momentRange, 1)
/// under the lobe cos^50. `interior` >= 1 texels, stored with their border.
std::vector<std::uint32_t> momentsLayer(const DistanceMap& distances, float momentRange,
                                        std::uint32_t interior);

/// ProbeLayer::MinDepth of a ProbeLayer::DepthNormal of `edge` texels, a multiple of 16: the smallest code of
/// each block of 16 x 16. Codes grow with distance and a miss is the largest, so this is exact and
/// conservative.
std::vector<std::uint16_t> minDepthLayer(std::span<const std::uint32_t> depthNormal, std::uint32_t edge);

/// ProbeLayer::Light at `edge` from light traced at a multiple of it: mean over the texels of each block that
/// see a surface, weighted by solid angle; 0 where none does. `light` holds I, `depthNormal` the words at the
/// same edge.
std::vector<std::uint32_t> lightLayer(const RadianceMap& light, std::span<const std::uint32_t> depthNormal,
                                      std::uint32_t edge);

/// A bilinear lookup in a stored Irradiance layer, as shaders do it; by direction of the normal.
glm::vec3 lookupIrradiance(std::span<const std::uint32_t> words, std::uint32_t interior, glm::vec3 normal);
/// The same in a Moments layer.
glm::vec2 lookupMoments(std::span<const std::uint32_t> words, std::uint32_t interior, glm::vec3 direction);

}  // namespace pfvox
