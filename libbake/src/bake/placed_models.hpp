// The visible instances of a loaded scene, flat: what placement, emitters and surface samples go through.
#pragma once

#include <pfvox/scene.hpp>
#include <vector>

namespace pfvox::bake {

/// Not empty, not hidden, of a transform that can be inverted.
struct PlacedModel {
    const OctreeModel* model = nullptr;
    const OctreeAsset* asset = nullptr;
    Affine worldFromModel = identityAffine();  ///< voxels to metres, from the origin that was asked for on
    Affine modelFromWorld = identityAffine();
};

std::vector<PlacedModel> placedModels(const LoadedScene& scene, const glm::dvec3& origin = glm::dvec3(0.0));

/// The shortest edge of a voxel in the world; 0 without models.
float finestVoxelMetres(const std::vector<PlacedModel>& models);

}  // namespace pfvox::bake
