// Carry scene: a scene.toml among the inputs appears at its mirrored place, its model paths turned to the
// PF_VOX files (docs/decisions/009-scene-carry-over.md).
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <span>

#include "vox2pf/convert_asset.hpp"

namespace pfvox::tools {

/// Whether a file of a folder is a scene, by its name: scene.toml or *.scene.toml, in any case.
bool isSceneName(const std::filesystem::path& file);

/// What every source of a run becomes.
class OutputsOfRun {
  public:
    OutputsOfRun() = default;
    explicit OutputsOfRun(std::span<const AssetTask> tasks);

    /// Where the PF_VOX file of this source is written; null when it is no input of the run.
    const std::filesystem::path* outputOf(const std::filesystem::path& source) const;
    bool writes(const std::filesystem::path& output) const;

  private:
    struct Entry {
        std::filesystem::path source;
        std::filesystem::path output;
    };
    using Entries = std::map<std::filesystem::path, Entry>;

    Entries byPlace_;      ///< of the source; of links to one file each has its own
    Entries byCanonical_;  ///< for those who come another way
    std::set<std::filesystem::path> outputs_;
};

/// Like convertAsset, for a scene. Nothing but the model paths changes. Diagnostics: those of parseScene;
/// scene-missing-model, scene-model-not-converted.
AssetResult carryScene(const AssetTask& task, const OutputsOfRun& outputs, const ConvertPolicy& policy,
                       const Limits& limits);

}  // namespace pfvox::tools
