#include "compose/model_shelf.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace pfvox::viewer {

namespace fs = std::filesystem;

std::shared_ptr<const OctreeAsset> ModelShelf::find(const fs::path& file) const {
    const auto found = assets_.find(file);
    return found == assets_.end() ? nullptr : found->second;
}

void ModelShelf::put(const fs::path& file, std::shared_ptr<const OctreeAsset> asset) {
    assets_[file] = std::move(asset);
}

Result<std::shared_ptr<const OctreeAsset>> readModel(const fs::path& file, Diagnostics& diagnostics) {
    if (file.extension() == ".toml")
        return fail(ErrorCode::BadMagic,
                    file.string() + ": a scene cannot stand in a scene; open it, or add its models");
    PFVOX_TRY(const LoadedScene, loaded, loadScene(file, Limits{}, diagnostics));
    return loaded.parts.front().asset;
}

std::vector<fs::path> missingModels(const SceneEditor& editor, const ModelShelf& shelf) {
    std::vector<fs::path> missing;
    for (const SceneModel& model : editor.scene().models) {
        if (!model.visible) continue;
        fs::path file = editor.fileOf(model);
        if (shelf.find(file) == nullptr) missing.push_back(std::move(file));
    }
    std::ranges::sort(missing);
    missing.erase(std::unique(missing.begin(), missing.end()), missing.end());
    return missing;
}

Result<LoadedScene> arranged(const SceneEditor& editor, const ModelShelf& shelf, Diagnostics& diagnostics) {
    LoadedScene loaded{.scene = editor.scene(), .parts = {}, .bounds = {}, .probes = {}};
    std::uint64_t instances = 0;
    for (std::size_t i = 0; i < loaded.scene.models.size(); ++i) {
        const SceneModel& model = loaded.scene.models[i];
        if (!model.visible) continue;
        std::shared_ptr<const OctreeAsset> asset = shelf.find(editor.fileOf(model));
        instances += asset->instances.size();
        if (instances > Limits{}.maxInstances) {
            return fail(ErrorCode::LimitExceeded,
                        fmt::format("with model '{}' the scene has more than {} instances", labelOf(model),
                                    Limits{}.maxInstances));
        }
        const Affine world = worldFromAsset(model, *asset);
        const WorldBounds bounds = boundsOf(*asset, world);
        if (!bounds.empty()) {
            loaded.bounds.include(bounds.min);
            loaded.bounds.include(bounds.max);
        }
        loaded.parts.push_back({.asset = std::move(asset), .worldFromAsset = world, .model = i});
    }
    PFVOX_TRY(const ProbeGrid, probes, fitProbeGrid(loaded.scene.probes, loaded.bounds, diagnostics));
    loaded.probes = probes;
    return loaded;
}

std::vector<WorldBounds> assetBoxesOf(const LoadedScene& scene) {
    std::map<const OctreeAsset*, WorldBounds> known;
    std::vector<WorldBounds> boxes;
    for (const PlacedAsset& part : scene.parts) {
        const auto [entry, isNew] = known.try_emplace(part.asset.get());
        if (isNew) entry->second = boundsOf(*part.asset);
        boxes.push_back(entry->second);
    }
    return boxes;
}

WorldBounds boundsOfModel(const LoadedScene& scene, std::size_t model) {
    for (const PlacedAsset& part : scene.parts) {
        if (part.model == model) return boundsOf(*part.asset, part.worldFromAsset);
    }
    return {};
}

glm::dvec3 placeBeside(const WorldBounds& box, const OctreeAsset& asset) {
    const WorldBounds own = boundsOf(asset);
    if (box.empty() || own.empty()) return glm::dvec3(0.0);
    const double gap = 0.1 * std::max(own.max.x - own.min.x, 0.1 * (box.max.x - box.min.x));
    return {box.max.x + gap - own.min.x, box.min.y - own.min.y,
            0.5 * (box.min.z + box.max.z) - 0.5 * (own.min.z + own.max.z)};
}

}  // namespace pfvox::viewer
