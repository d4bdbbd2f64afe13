// Light filter: takes the noise out of a probe's light map before it is stored.
//
//     what the texels see, light, its errors -> [filterLight] -> light
//
// Texels that show the same planes share their light where it does not differ by more than its noise: passes
// of a 5 x 5 kernel whose taps move apart from pass to pass (Dammertz et al. 2010, "Edge-Avoiding A-Trous
// Wavelet Transform"), guided by the variance, which each pass carries on (Schied et al. 2017,
// "Spatiotemporal Variance-Guided Filtering"). A difference counts by the noise of both texels, so that
// neighbors take from a texel that is bright by chance; not all of it: a few percent of the light are lost
// where few paths carry most of it (docs/baking.md). Where the light is known well, nothing changes: the
// error falls with the number of paths as before, from a lower start.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace pfvox::filter {

struct LightMap {
    std::span<const std::uint32_t> words;  ///< of ProbeLayer::DepthNormal, depthResolution squared
    std::span<const float> metres;         ///< along the texel's direction, < 0 = nothing; as many
    std::uint32_t depthResolution = 0;     ///< a multiple of lightResolution
    std::span<const glm::vec3> light;      ///< I, lightResolution squared
    std::uint32_t lightResolution = 0;
    /// Standard errors of the mean of the channels, one a texel of the light map; empty or 0: guessed from
    /// how much the light of neighbors differs.
    std::span<const float> errors;
    float voxelMetres = 0.1f;  ///< of the finest model
};

struct LightFilterSettings {
    float noiseScale = 4.0f;    ///< a difference of so many standard errors counts a quarter
    float planeVoxels = 0.25f;  ///< how far apart two planes may lie
    /// Texels so far apart count a quarter: so many voxels, or so many times what a texel covers of its
    /// surface, whichever is farther. Where a texel covers more than a few voxels, its neighbors are as near
    /// as light can be known.
    float reachVoxels = 2.0f;
    float reachTexels = 2.0f;
};

/// Of the same size as `light`; texels without surface stay as they are. Does not depend on threads or
/// devices.
std::vector<glm::vec3> filterLight(const LightMap& map, const LightFilterSettings& settings);

}  // namespace pfvox::filter
