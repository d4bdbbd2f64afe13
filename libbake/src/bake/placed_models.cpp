#include "bake/placed_models.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pfvox::bake {

namespace {

bool isFinite(const Affine& m) {
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 3; ++row)
            if (!(std::abs(m[column][row]) < 1e30)) return false;
    return true;
}

}  // namespace

std::vector<PlacedModel> placedModels(const LoadedScene& scene, const glm::dvec3& origin) {
    std::vector<PlacedModel> placed;
    for (const PlacedAsset& part : scene.parts) {
        for (const Instance& instance : part.asset->instances) {
            if (isHidden(*part.asset, instance) || instance.model >= part.asset->models.size()) continue;
            const OctreeModel& model = part.asset->models[instance.model];
            if (model.regions.empty()) continue;
            Affine world = compose(part.worldFromAsset, instance.worldFromModel);
            world[3] -= origin;
            const Affine inverse{glm::inverse(glm::dmat4{world})};
            if (!isFinite(inverse)) continue;
            placed.push_back({&model, part.asset.get(), world, inverse});
        }
    }
    return placed;
}

float finestVoxelMetres(const std::vector<PlacedModel>& models) {
    double finest = std::numeric_limits<double>::infinity();
    for (const PlacedModel& placed : models)
        for (int axis = 0; axis < 3; ++axis)
            finest = std::min(finest, glm::length(glm::dvec3(placed.worldFromModel[axis])));
    return std::isfinite(finest) ? static_cast<float>(finest) : 0.0f;
}

}  // namespace pfvox::bake
