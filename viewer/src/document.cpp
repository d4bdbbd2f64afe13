#include "document.hpp"

#include <pfvox/face_file.hpp>

#include <algorithm>
#include <pfvox/bake.hpp>
#include <system_error>
#include <utility>

#include "view_passes.hpp"

namespace pfvox::viewer {

namespace fs = std::filesystem;

namespace {

constexpr double kPollSeconds = 0.25;

bool isModelFile(const fs::path& file) {
    return file.extension() == ".pf_vox";
}

bool sameModels(const LoadedScene& a, const LoadedScene& b) {
    const auto same = [](const PlacedAsset& x, const PlacedAsset& y) {
        return x.asset == y.asset && x.model == y.model && x.worldFromAsset == y.worldFromAsset;
    };
    return std::ranges::equal(a.parts, b.parts, same);
}

}  // namespace

// ---- Files -----------------------------------------------------------------------------------------------

void Document::open(const fs::path& path) {
    composer.leave([this, path] { openNow(path); });
}

void Document::openNow(const fs::path& path) {
    Result<OpenPath> opened = openPath(path);
    if (!opened) return log_->addError(describe(opened.error()));
    probeRequest_ = std::exchange(first_, {});
    if (!opened->probes.empty()) probeRequest_ = {.file = opened->probes};
    load(*std::move(opened), false);
}

void Document::reload() {
    if (!wanted_.file.empty()) load(wanted_, shown_ && shown_->path.file == wanted_.file);
}

void Document::openNeighbor(int step) {
    if (wanted_.siblings.size() < 2) {
        log_->add(MessageKind::Note, "there is no other file: open a folder to go through its files");
        return;
    }
    composer.leave([this, step] {
        probeRequest_ = {};  // those of the file that is left are not the next one's
        load({.file = neighborOf(wanted_, step), .siblings = wanted_.siblings}, false);
    });
}

void Document::load(OpenPath path, bool keepCamera) {
    wanted_ = path;
    // Watched from before they are read: what changes meanwhile is not missed.
    DiagnosticList ignored;
    const bool isScene = path.file.extension() == ".toml";
    const Result<Scene> scene = isScene ? readScene(path.file, Limits{}, ignored) : Result<Scene>(Scene{});
    watchFiles(scene ? *scene : Scene{});
    const fs::path file = path.file;
    loading_ = Loading{.path = std::move(path),
                       .keepCamera = keepCamera,
                       .scene = Background<Result<LoadedScene>>(
                           [file, read = read_](Diagnostics& said) { return read(file, Limits{}, said); })};
}

void Document::watchFiles(const Scene& scene) {
    std::vector<fs::path> files = filesOf(wanted_.file, scene);
    if (wanted_.file.empty()) {  // a new scene
        files.clear();
        for (const SceneModel& model : scene.models) files.push_back(composer.editor.fileOf(model));
    }
    const fs::path probes = probeRequest_.file.empty() ? probesBeside(wanted_.file) : probeRequest_.file;
    if (!probeRequest_.none && !probes.empty()) files.push_back(probes);
    watch_.watch(files);
}

void Document::update(double secondsSinceStart) {
    takeLoaded();
    applyEdits();
    if (secondsSinceStart < nextPoll_) return;
    nextPoll_ = secondsSinceStart + kPollSeconds;
    if (!loading_ && watch_.poll()) filesChanged();
}

void Document::takeLoaded() {
    if (!loading_) return;
    std::optional<Result<LoadedScene>> loaded = loading_->scene.take(*log_);
    if (!loaded) return;
    Loading done = *std::exchange(loading_, std::nullopt);
    const std::string name = done.path.file.string();
    if (!*loaded) return log_->addError(describe(loaded->error()));
    log_->dismissStrip();  // before: what is wrong with the probes is to stay
    const Result<void> shown = show(std::move(done.path), **std::move(loaded), done.keepCamera);
    shown ? log_->add(MessageKind::Note, "shows " + name) : log_->addError(describe(shown.error()));
}

Result<void> Document::show(OpenPath path, LoadedScene loaded, bool keepCamera) {
    PFVOX_TRY(
        gpu::Scene, scene,
        gpu::Scene::build(*device_, gpu::partsOf(loaded), *log_, {.origin = loaded.origin(), .faces = true}));
    if (!keepCamera) probes_.reset();
    emitters_.reset();
    std::vector<WorldBounds> boxes = assetBoxesOf(loaded);
    shown_.emplace(ShownScene{std::move(path), std::move(loaded), std::move(scene), std::move(boxes)});
    composer.begin(shown_->path.file, shown_->loaded);
    findProbesOf(*shown_);
    if (!keepCamera) ++revisions_.opened;
    ++revisions_.shown;
    return {};
}

void Document::newScene() {
    composer.leave([this] { showNothing(); });
}

void Document::showNothing() {
    const LoadedScene nothing;
    Result<gpu::Scene> scene = gpu::Scene::build(*device_, gpu::partsOf(nothing), *log_, {.faces = true});
    if (!scene) return log_->addError(describe(scene.error()));
    std::error_code ignored;
    composer.beginEmpty(fs::current_path(ignored));
    loading_.reset();
    wanted_ = {};
    probeRequest_ = {};
    probes_.reset();
    emitters_.reset();
    shown_.emplace(ShownScene{.path = {}, .loaded = nothing, .scene = *std::move(scene)});
    watchFiles({});
    ++revisions_.opened;
    ++revisions_.shown;
    ++revisions_.pixels;
}

void Document::addModels(const std::vector<fs::path>& files) {
    if (!shown_) newScene();
    composer.addModels(files);
}

void Document::drop(const std::vector<fs::path>& files) {
    if (files.empty()) return;
    const bool isComposed = shown_ && (!isModelFile(shown_->path.file) || composer.editor.isChanged());
    if (isComposed && std::ranges::all_of(files, isModelFile)) return addModels(files);
    open(files.back());
}

void Document::filesChanged() {
    const SceneEditor& editor = composer.editor;
    const bool edited = editor.canUndo() || editor.canRedo();
    if (!edited) return reload();
    DiagnosticList ignored;
    const bool sceneIsOurs =
        editor.file().empty() || readScene(editor.file(), Limits{}, ignored) == editor.saved();
    if (!sceneIsOurs && !editor.isChanged()) return reload();
    if (!sceneIsOurs) {
        log_->addError(editor.file().string() +
                       ": another program has changed this file. Your changes are kept here: save "
                       "them to replace it, or read it again (R) to lose them");
    }
    composer.readAgain();
    if (shown_) findProbesOf(*shown_);
}

// ---- The scene on the screen follows the edits -----------------------------------------------------------

void Document::applyEdits() {
    if (!shown_ || loading_) return;
    if (composer.takeWritten()) followSavedFile();
    std::optional<LoadedScene> scene = composer.update();
    if (scene) composer.tell(rearrange(*std::move(scene)));
}

/// What we wrote ourselves is not read again.
void Document::followSavedFile() {
    const fs::path& file = composer.editor.file();
    if (shown_->path.file != file) {
        shown_->path = {.file = file, .siblings = {file}};
        wanted_ = shown_->path;
        std::error_code ignored;
        const bool takesThoseBeside = !probeRequest_.none && probeRequest_.file.empty();
        if (takesThoseBeside && fs::exists(probesBeside(file), ignored)) findProbesOf(*shown_);
    }
    watchFiles(composer.editor.scene());
    if (probes_) probes_->ofThisScene = probes_->info.sceneHash == sceneContentHash(shown_->loaded);
}

Result<void> Document::rearrange(LoadedScene loaded) {
    const bool moved = loaded.origin() != shown_->scene.origin();
    const bool otherFiles = loaded.scene.models.size() != shown_->loaded.scene.models.size();
    if (!sameModels(loaded, shown_->loaded)) {
        PFVOX_TRY(gpu::Scene, scene,
                  gpu::Scene::build(*device_, gpu::partsOf(loaded), *log_,
                                    {.known = &shown_->scene, .origin = loaded.origin(), .faces = true}));
        // Values are listed instance by instance: where there are others, they are nobody's.
        if (probes_ && probes_->faces && probes_->faceInstances != faceInstancesOf(scene))
            probes_->faces.reset();
        shown_->scene = std::move(scene);
        emitters_.reset();
        ++revisions_.pixels;
    }
    shown_->assetBoxes = assetBoxesOf(loaded);
    shown_->loaded = std::move(loaded);
    if (otherFiles) watchFiles(shown_->loaded.scene);
    if (moved) findProbesOf(*shown_);  // theirs count from another place now
    return {};
}

// ---- Light -----------------------------------------------------------------------------------------------

void Document::findProbesOf(const ShownScene& shown) {
    ++revisions_.pixels;
    Result<std::optional<ShownProbes>> found =
        findProbes(*device_, probeRequest_, shown.loaded, shown.scene, shown.path.file, *log_);
    if (!found) return log_->addError(describe(found.error()));
    probes_ = *std::move(found);
    log_->add(MessageKind::Note,
              probes_ ? "probes from " + probes_->file.string() : guessNote(shown.path.file));
}

void Document::loadProbes(const fs::path& file) {
    probeRequest_ = {.file = file};
    if (!shown_) return;
    findProbesOf(*shown_);
    watchFiles(shown_->loaded.scene);
}

void Document::dropProbes() {
    probeRequest_ = {.none = true};
    probes_.reset();
    ++revisions_.pixels;
}

Result<PictureInput> Document::inputOf(const PictureSettings& picture) {
    PictureInput input{shown_->scene, probes()};
    if (!isGuessed(input, picture)) return input;
    if (!emitters_) {
        PFVOX_TRY(GpuEmitters, made, GpuEmitters::upload(*device_, shown_->loaded, *log_));
        emitters_.emplace(std::move(made));
    }
    input.emitters = &*emitters_;
    return input;
}

// ---- What is asked ---------------------------------------------------------------------------------------

bool Document::showsSingleModel() const {
    return shown_ && isSingleModel(shown_->path.file, shown_->loaded.scene);
}

glm::dvec3 Document::placeOfProbe(std::uint32_t index) const {
    const bool sameGrid =
        probes_ && probes_->info.grid == shown_->loaded.probes && index < probes_->probes.size();
    return sameGrid ? probes_->probes[index].position
                    : shown_->loaded.probes.worldOf(shown_->loaded.probes.pointOf(index));
}

double Document::fileVoxelOfSelected() const {
    for (const PlacedAsset& part : shown_->loaded.parts) {
        if (part.model == composer.editor.selected()) return part.asset->source.voxelSizeMetres;
    }
    return 1.0;
}

}  // namespace pfvox::viewer
