// Compares the traversal on the GPU with the reference caster, ray by ray.
#pragma once

#include <cstddef>
#include <pfvox/gpu.hpp>
#include <pfvox/gpu_scene.hpp>
#include <pfvox/octree.hpp>
#include <span>
#include <string>
#include <vector>

#include "support/procedural.hpp"

namespace pfvox::test {

/// In floats, so that both sides cast the very same ray.
struct FloatRay {
    glm::vec3 origin;
    glm::vec3 direction;
};

struct RayFamily {
    std::string name;
    std::vector<FloatRay> rays;
};

/// Counts of one comparison. Where the sides differ, it is a tie if the ray passes the voxel that the GPU
/// names within the tie distance, and a ray within that distance of this one passes what the reference met
/// before; else it is a disagreement.
struct Comparison {
    std::size_t rays = 0;
    std::size_t hits = 0;
    std::size_t ties = 0;
    std::size_t disagreements = 0;
    std::size_t stepLimitReached = 0;
    std::string firstDisagreement;
};

/// Of the distance from the ray's origin to the far end of the scene, or of the octree cube's edge where that
/// is more: some 16 roundings of a float.
inline constexpr double kTieDistance = 2e-6;

/// Random, axis-parallel, aimed at corners and edges, from inside, grazing, and from far away.
std::vector<RayFamily> rayFamilies(Random& random, const OctreeAsset& asset, std::size_t raysPerFamily);

/// Casts the rays on both sides.
Comparison compare(gpu::Device& device, const OctreeAsset& asset, std::span<const FloatRay> rays);

/// The same for a scene of several parts; `asset` is what they are together.
Comparison compare(gpu::Device& device, std::span<const gpu::ScenePart> parts, const OctreeAsset& asset,
                   std::span<const FloatRay> rays);

}  // namespace pfvox::test
