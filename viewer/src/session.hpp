// Session: everything of the interactive viewer but the window: what is loaded, how it is seen, what commands
// do.
//
//     paths, commands, time -> Session -> pixels on the device, messages
//
// Files are read in the background; the scene on the screen stays until the next one is ready, and when that
// fails.
#pragma once

#include <deque>
#include <future>
#include <optional>
#include <pfvox/ray_query.hpp>

#include "atlas_layout.hpp"
#include "camera_choice.hpp"
#include "camera_controller.hpp"
#include "commands.hpp"
#include "compose/composer.hpp"
#include "compose/model_drag.hpp"
#include "file_watch.hpp"
#include "frame_sequence.hpp"
#include "interaction.hpp"
#include "message_log.hpp"
#include "open_path.hpp"
#include "pick.hpp"
#include "settings.hpp"
#include "shown_probes.hpp"

namespace pfvox::viewer {

/// A scene on the screen.
struct ShownScene {
    OpenPath path;
    LoadedScene loaded;
    gpu::Scene scene;
    std::vector<WorldBounds> assetBoxes = {};  ///< of each of loaded.parts, in the metres of its file
};

/// What the command line asks for.
struct SessionStart {
    std::filesystem::path path;
    CameraRequest camera;
    ViewMode mode = ViewMode::Final;
    ProbeRequest probes = {};  ///< of what is opened first; later files have those beside them
    AtlasChoice atlas = {};
    std::filesystem::path screenshotFolder = {};  ///< empty = where the program runs
    /// What reads files and scenes, on a thread of its own.
    std::function<Result<LoadedScene>(const std::filesystem::path&, const Limits&, Diagnostics&)> read =
        loadScene;
};

class Session {
  public:
    /// Begins to load. Errors: those of the programs on the device.
    static Result<std::unique_ptr<Session>> create(gpu::Device& device, const SessionStart& start,
                                                   Memory memory, MessageLog& log);

    /// Begins to load another file, scene or folder, after the question about unsaved changes.
    void open(const std::filesystem::path& path);
    /// The same files again; unsaved changes are lost.
    void reload();
    /// Probes from this file for what is shown, at once; on an error the probes so far stay and the strip
    /// tells. Empty = those beside the scene, if there are any.
    void loadProbes(const std::filesystem::path& file);
    /// Light without probes until the next loadProbes() or open().
    void dropProbes();
    void execute(const KeyBinding& binding);
    /// Tells what is at a point of the picture: parts of its edges from the upper left. Its model becomes
    /// selected.
    void pickAt(glm::dvec2 parts);

    // Composing (session_compose.cpp).
    void newScene();
    /// Models dropped upon a scene are added to it; else the last one is opened.
    void drop(const std::vector<std::filesystem::path>& files);
    /// Begins to read; a new scene when there is none.
    void addModels(const std::vector<std::filesystem::path>& files);
    /// Ends the program, after the question about unsaved changes.
    void quit();
    /// A probe of the grid that is drawn, else as pickAt().
    void clickAt(glm::dvec2 parts);
    /// Takes hold of the handle there, if there is one.
    bool grabAt(glm::dvec2 parts);
    void drag(const Drag& drag);
    /// Camera and window as they are: what is drawn upon the picture goes through it.
    Projection projection() const { return {camera.camera(), windowSize}; }
    /// At the selected model; nothing when none that is seen is selected.
    std::optional<Gizmo> gizmo() const;
    void frameSelected();
    /// The present view becomes a camera of the scene.
    void addCamera();
    /// Where a probe of the shown scene's grid stands, or will: of a baked field of the same grid it is the
    /// place after relocation. Precondition: shown() and an index of its grid.
    glm::dvec3 placeOfProbe(std::uint32_t index) const;
    /// Of the file of the selected model, metres. Precondition: shown().
    double fileVoxelOfSelected() const;
    void frameAll();
    /// A PF_VOX file to which nothing was added; such a model stands on a ground unless `settings` says
    /// otherwise.
    bool showsSingleModel() const;

    /// Takes over what has been loaded, looks after changed files.
    void update(double secondsSinceStart);
    /// Draws one frame for a window of this many pixels, if it would differ from what pixels() holds. Errors:
    /// GpuLost, GpuOutOfMemory.
    Result<void> draw(glm::uvec2 windowPixels);
    /// Whether another draw() would change something.
    bool needsFrame(glm::uvec2 windowPixels) const;

    const FrameSequence& frames() const { return frames_; }
    const ShownScene* shown() const { return shown_ ? &*shown_ : nullptr; }
    /// Null without probes.
    const ShownProbes* probes() const { return probes_ ? &*probes_ : nullptr; }
    bool isLoading() const { return loading_.has_value(); }
    bool wantsToQuit() const { return quit_; }
    gpu::Device& device() const { return *device_; }
    MessageLog& log() const { return *log_; }
    const PictureStatistics& statistics() const { return statistics_; }
    const std::deque<float>& frameTimesMs() const { return frameTimesMs_; }  ///< the latest last
    const std::optional<Pick>& pick() const { return pick_; }
    /// Settings and cameras as they are to be remembered.
    Memory memory() const;

    /// Where the maps lie when the picture is a page of them, in pixels of frames(); then no scene is under
    /// the cursor.
    std::optional<AtlasLayout> shownAtlas() const;

    // What windows change.
    CameraController camera;
    Settings settings;
    Lighting lighting;                ///< without the exposure, which is in `settings`
    ViewMode mode = ViewMode::Final;  ///< one that checkView refuses shows the final picture instead
    AtlasChoice atlas;                ///< which probes the atlas views show
    bool showHelp = false;
    Composer composer;
    std::optional<std::uint32_t> selectedProbe;  ///< index in the grid of the shown scene
    glm::dvec2 windowSize{1280.0, 720.0};        ///< in the unit of cursor positions

  private:
    void forgetLoading();
    struct Loading {
        OpenPath path;
        bool keepCamera = false;
        std::future<Result<LoadedScene>> scene;
    };
    Session(gpu::Device& device, FrameSequence frames, gpu::RayQuery query, MessageLog& log)
        : composer(log), device_(&device), log_(&log), frames_(std::move(frames)), query_(std::move(query)) {}
    void openNow(const std::filesystem::path& path);
    void load(OpenPath path, bool keepCamera);
    void applyEdits();
    Result<void> rearrange(LoadedScene loaded);
    void followSavedFile();
    void filesChanged();
    void executeEdit(const KeyBinding& binding);
    void moveSelected(MoveDirection direction);
    void changeSelected(const std::function<SceneModel(const SceneModel&, const WorldBounds&)>& change);
    bool selectProbeAt(glm::dvec2 parts);
    void findProbesOf(const ShownScene& shown);
    void watchFiles(const Scene& scene);
    void setMode(ViewMode wanted);
    Result<void> show(OpenPath path, LoadedScene loaded, bool keepCamera);
    Result<void> placeCamera(const std::filesystem::path& file, const Scene& scene);
    void rememberCamera();
    void nextCamera();
    void openNeighbor(int step);
    void writeScreenshot();
    PictureSettings pictureSettings(glm::uvec2 windowPixels) const;
    Result<const GpuEmitters*> emittersFor(const PictureSettings& picture);
    double aspect() const;

    gpu::Device* device_;
    MessageLog* log_;
    FrameSequence frames_;
    gpu::RayQuery query_;
    CameraMemory cameras_;
    SessionStart start_;
    OpenPath wanted_;  ///< what was opened last, whether or not it could be
    std::optional<ShownScene> shown_;
    std::optional<ShownProbes> probes_;
    std::optional<GpuEmitters> emitters_;  ///< of shown_, once they are needed
    ProbeRequest probeRequest_;
    std::optional<Loading> loading_;
    std::vector<std::future<Result<LoadedScene>>> outdated_;  ///< what nobody waits for any more
    FileWatch watch_;
    double nextPoll_ = 0.0;
    std::optional<std::pair<ViewCamera, PictureSettings>> drawn_;
    PictureStatistics statistics_;
    std::deque<float> frameTimesMs_;
    std::optional<Pick> pick_;
    std::size_t sceneCamera_ = 0;
    std::optional<ModelDrag> drag_;
    bool quit_ = false;
};

}  // namespace pfvox::viewer
