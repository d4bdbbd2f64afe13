// Document: what is open: the files, the scene that is on the screen, the probes that light it, and its
// edits.
//
//     paths, edits -> [Document] -> scene and probes on the device, messages
//
// Files are read in the background; the scene on the screen stays until the next one is ready, and when that
// fails. Knows no camera: who looks at it follows its revisions.
#pragma once

#include <functional>
#include <optional>

#include "background.hpp"
#include "compose/composer.hpp"
#include "file_watch.hpp"
#include "message_log.hpp"
#include "open_path.hpp"
#include "picture.hpp"
#include "shown_probes.hpp"

namespace pfvox::viewer {

/// A scene on the screen.
struct ShownScene {
    OpenPath path;
    LoadedScene loaded;
    gpu::Scene scene;
    std::vector<WorldBounds> assetBoxes = {};  ///< of each of loaded.parts, in the metres of its file
};

/// Each counts up.
struct Revisions {
    std::uint64_t opened = 0;  ///< another file or a new scene: it is seen by another camera
    std::uint64_t shown = 0;   ///< files were read, for the first time or again
    std::uint64_t pixels = 0;  ///< models or probes changed: frames so far show something else
    bool operator==(const Revisions&) const = default;
};

class Document {
  public:
    using Read =
        std::function<Result<LoadedScene>(const std::filesystem::path&, const Limits&, Diagnostics&)>;

    /// `read` reads files and scenes, on a thread of its own. `probes`: of what is opened first; later files
    /// have those beside them.
    Document(gpu::Device& device, MessageLog& log, Read read, ProbeRequest probes)
        : composer(log), device_(&device), log_(&log), read_(std::move(read)), first_(std::move(probes)) {}

    /// Begins to load a file, scene or folder, after the question about unsaved changes.
    void open(const std::filesystem::path& path);
    /// The same files again; unsaved changes are lost.
    void reload();
    /// `step` files further in the folder that was opened, after the question.
    void openNeighbor(int step);
    /// An empty scene without a file, after the question.
    void newScene();
    /// Begins to read; a new scene when there is none.
    void addModels(const std::vector<std::filesystem::path>& files);
    /// Models dropped upon a scene are added to it; else the last one is opened.
    void drop(const std::vector<std::filesystem::path>& files);
    /// Probes from this file for what is shown, at once; on an error the probes so far stay and the strip
    /// tells. Empty = those beside the scene, if there are any.
    void loadProbes(const std::filesystem::path& file);
    /// Light without probes until the next loadProbes() or open().
    void dropProbes();

    /// Takes over what has been read and edited, looks after changed files.
    void update(double secondsSinceStart);

    const ShownScene* shown() const { return shown_ ? &*shown_ : nullptr; }
    /// Null without probes.
    const ShownProbes* probes() const { return probes_ ? &*probes_ : nullptr; }
    /// What a picture with these settings is drawn from. Precondition: shown(). Errors: those of
    /// GpuEmitters::upload.
    Result<PictureInput> inputOf(const PictureSettings& picture);
    const Revisions& revisions() const { return revisions_; }
    bool isLoading() const { return loading_.has_value(); }
    /// A PF_VOX file to which nothing was added; such a model stands on a ground unless settings say
    /// otherwise.
    bool showsSingleModel() const;
    /// Where a probe of the shown scene's grid stands, or will: of a baked field of the same grid it is the
    /// place after relocation. Precondition: shown() and an index of its grid.
    glm::dvec3 placeOfProbe(std::uint32_t index) const;
    /// Of the file of the selected model, metres. Precondition: shown().
    double fileVoxelOfSelected() const;
    gpu::Device& device() const { return *device_; }
    MessageLog& log() const { return *log_; }

    Composer composer;  ///< what windows and commands edit

  private:
    struct Loading {
        OpenPath path;
        bool keepCamera = false;
        Background<Result<LoadedScene>> scene;
    };
    void openNow(const std::filesystem::path& path);
    void load(OpenPath path, bool keepCamera);
    void takeLoaded();
    Result<void> show(OpenPath path, LoadedScene loaded, bool keepCamera);
    void showNothing();
    void applyEdits();
    Result<void> rearrange(LoadedScene loaded);
    void followSavedFile();
    void filesChanged();
    void findProbesOf(const ShownScene& shown);
    void watchFiles(const Scene& scene);

    gpu::Device* device_;
    MessageLog* log_;
    Read read_;
    ProbeRequest first_;
    OpenPath wanted_;  ///< what was opened last, whether or not it could be
    std::optional<ShownScene> shown_;
    std::optional<ShownProbes> probes_;
    std::optional<GpuEmitters> emitters_;  ///< of shown_, once they are needed
    ProbeRequest probeRequest_;
    std::optional<Loading> loading_;
    FileWatch watch_;
    double nextPoll_ = 0.0;
    Revisions revisions_;
};

}  // namespace pfvox::viewer
