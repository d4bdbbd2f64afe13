// From assets to the records of shared/scene.glsl.h, on the CPU: which instances take part, their boxes and
// matrices.
#pragma once

#include <pfvox/gpu_scene.hpp>
#include <vector>

#include "scene/bvh.hpp"
#include "shared/scene.glsl.h"

namespace pfvox::gpu::detail {

/// A model that some visible instance uses.
struct UsedModel {
    const OctreeModel* model = nullptr;
    const std::vector<Material>* materials = nullptr;  ///< of its asset
    std::uint32_t firstMaterial = 0;                   ///< of its asset, in the scene's material list
};

struct SceneRecords {
    std::vector<UsedModel> models;
    std::vector<shared::InstanceRecord> instances;  ///< in BVH order
    std::vector<Affine> frameFromModel;             ///< an instance; from the origin
    std::vector<shared::MaterialRecord> materials;
    std::vector<shared::BvhNode> bvhNodes;
    bool hasGlass = false;
    bool hasMirrors = false;
    WorldBox bounds;  ///< in the world; boxes and matrices count from the origin
};

/// Errors and diagnostics: see Scene::build.
Result<SceneRecords> makeRecords(std::span<const ScenePart> parts, const glm::dvec3& origin,
                                 Diagnostics& diagnostics);

/// All of a model's record but the address of its root block.
shared::ModelRecord recordOf(const OctreeModel& model);

}  // namespace pfvox::gpu::detail
