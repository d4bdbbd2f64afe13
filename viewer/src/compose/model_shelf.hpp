// ModelShelf: the PF_VOX files of a scene in memory, each once, so that an edit reads nothing again.
//
//     Scene + shelf -> [arranged] -> LoadedScene
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <pfvox/scene.hpp>

#include "compose/scene_editor.hpp"

namespace pfvox::viewer {

class ModelShelf {
  public:
    /// Null = not there. The path is that of SceneEditor::fileOf.
    std::shared_ptr<const OctreeAsset> find(const std::filesystem::path& file) const;
    void put(const std::filesystem::path& file, std::shared_ptr<const OctreeAsset> asset);
    void clear() { assets_.clear(); }

  private:
    std::map<std::filesystem::path, std::shared_ptr<const OctreeAsset>> assets_;
};

/// Reads one PF_VOX file. Errors: those of loadScene on it.
Result<std::shared_ptr<const OctreeAsset>> readModel(const std::filesystem::path& file,
                                                     Diagnostics& diagnostics);

/// Files of visible models that the shelf does not have, each once.
std::vector<std::filesystem::path> missingModels(const SceneEditor& editor, const ModelShelf& shelf);

/// The edited scene with its models where they stand. Precondition: missingModels() is empty. Errors:
/// LimitExceeded (instances, probes of the grid).
Result<LoadedScene> arranged(const SceneEditor& editor, const ModelShelf& shelf, Diagnostics& diagnostics);

/// Boxes of the parts in the metres of their files, each file looked at once.
std::vector<WorldBounds> assetBoxesOf(const LoadedScene& scene);

/// Box of one model of the scene; empty when it is hidden or not loaded.
WorldBounds boundsOfModel(const LoadedScene& scene, std::size_t model);

/// Where a model stands so that it is beside the box, on the box' floor; the origin when the box is empty.
glm::dvec3 placeBeside(const WorldBounds& box, const OctreeAsset& asset);

}  // namespace pfvox::viewer
