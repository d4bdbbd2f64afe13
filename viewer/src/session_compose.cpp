// The part of Session that edits: what changes the document, and how the picture follows it.
#include <algorithm>
#include <pfvox/bake.hpp>
#include <system_error>

#include "compose/model_edits.hpp"
#include "session.hpp"

namespace pfvox::viewer {

namespace fs = std::filesystem;

namespace {

constexpr double kResizeFactor = 1.1;

bool isModelFile(const fs::path& file) {
    return file.extension() == ".pf_vox";
}

bool sameModels(const LoadedScene& a, const LoadedScene& b) {
    const auto same = [](const PlacedAsset& x, const PlacedAsset& y) {
        return x.asset == y.asset && x.model == y.model && x.worldFromAsset == y.worldFromAsset;
    };
    return std::ranges::equal(a.parts, b.parts, same);
}

gpu::WorldBox worldBoxOf(const WorldBounds& bounds) {
    return {.min = bounds.min, .max = bounds.max};
}

glm::dvec3 vectorOf(MoveDirection direction) {
    switch (direction) {
        case MoveDirection::Left:
            return {-1, 0, 0};
        case MoveDirection::Right:
            return {1, 0, 0};
        case MoveDirection::Back:
            return {0, 0, -1};
        case MoveDirection::Front:
            return {0, 0, 1};
        case MoveDirection::Down:
            return {0, -1, 0};
        case MoveDirection::Up:
            return {0, 1, 0};
    }
    return glm::dvec3(0.0);
}

}  // namespace

// ---- Files -----------------------------------------------------------------------------------------------

void Session::newScene() {
    composer.leave([this] {
        const LoadedScene nothing;
        Result<gpu::Scene> scene = gpu::Scene::build(*device_, gpu::partsOf(nothing), *log_);
        if (!scene) return log_->addError(describe(scene.error()));
        rememberCamera();
        std::error_code ignored;
        composer.beginEmpty(fs::current_path(ignored));
        forgetLoading();
        wanted_ = {};
        probeRequest_ = {};
        probes_.reset();
        emitters_.reset();
        selectedProbe.reset();
        pick_.reset();
        shown_.emplace(ShownScene{.path = {}, .loaded = nothing, .scene = *std::move(scene)});
        watchFiles({});
        frames_.restart();
        drawn_.reset();
    });
}

void Session::quit() {
    composer.leave([this] { quit_ = true; });
}

void Session::openNeighbor(int step) {
    if (wanted_.siblings.size() < 2) {
        log_->add(MessageKind::Note, "there is no other file: open a folder to go through its files");
        return;
    }
    composer.leave([this, step] {
        probeRequest_ = {};  // those of the file that is left are not the next one's
        load({.file = neighborOf(wanted_, step), .siblings = wanted_.siblings}, false);
    });
}

void Session::addModels(const std::vector<fs::path>& files) {
    if (!shown_) newScene();
    composer.addModels(files);
}

void Session::drop(const std::vector<fs::path>& files) {
    if (files.empty()) return;
    const bool isComposed = shown_ && (!isModelFile(shown_->path.file) || composer.editor.isChanged());
    if (isComposed && std::ranges::all_of(files, isModelFile)) return addModels(files);
    open(files.back());
}

void Session::filesChanged() {
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

// ---- The picture follows the document --------------------------------------------------------------------

void Session::applyEdits() {
    if (!shown_ || loading_) return;
    if (composer.takeWritten()) followSavedFile();
    std::optional<LoadedScene> scene = composer.update();
    if (!scene) return;
    const Result<void> done = rearrange(*std::move(scene));
    if (!done) log_->addError(describe(done.error()));
}

/// What we wrote ourselves is not read again.
void Session::followSavedFile() {
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

Result<void> Session::rearrange(LoadedScene loaded) {
    const bool wasEmpty = shown_->loaded.bounds.empty();
    const bool otherFiles = loaded.scene.models.size() != shown_->loaded.scene.models.size();
    if (!sameModels(loaded, shown_->loaded)) {
        PFVOX_TRY(gpu::Scene, scene,
                  gpu::Scene::build(*device_, gpu::partsOf(loaded), *log_, &shown_->scene));
        shown_->scene = std::move(scene);
        emitters_.reset();
        pick_.reset();
        frames_.restart();
        drawn_.reset();
    }
    lighting = lightingOf(loaded.scene);
    if (loaded.probes.counts != shown_->loaded.probes.counts) selectedProbe.reset();
    shown_->assetBoxes = assetBoxesOf(loaded);
    shown_->loaded = std::move(loaded);
    if (otherFiles) watchFiles(shown_->loaded.scene);
    if (wasEmpty) frameAll();
    return {};
}

// ---- Selecting and dragging ------------------------------------------------------------------------------

void Session::clickAt(glm::dvec2 parts) {
    if (!selectProbeAt(parts)) pickAt(parts);
}

std::optional<Gizmo> Session::gizmo() const {
    if (!shown_ || !settings.showWindows || !composer.editor.selected() || shownAtlas()) return std::nullopt;
    const WorldBounds box = boundsOfModel(shown_->loaded, *composer.editor.selected());
    if (box.empty()) return std::nullopt;
    const Gizmo gizmo(projection(), footOf(box));
    return gizmo.isSeen() ? std::optional(gizmo) : std::nullopt;
}

bool Session::grabAt(glm::dvec2 parts) {
    const std::optional<Gizmo> handles = gizmo();
    if (!handles) return false;
    const std::optional<Handle> handle = handles->handleAt(parts * windowSize);
    if (!handle) return false;
    composer.editor.endGesture();
    drag_.emplace(composer.editor, *handles, *handle, parts * windowSize);
    return true;
}

void Session::drag(const Drag& drag) {
    if (!drag_) return;
    composer.tell(drag_->moveTo(drag.to * windowSize, composer.editor));
    if (!drag.ended) return;
    drag_.reset();
    composer.editor.endGesture();
}

void Session::frameSelected() {
    if (!shown_ || !composer.editor.selected()) return frameAll();
    const WorldBounds box = boundsOfModel(shown_->loaded, *composer.editor.selected());
    box.empty() ? frameAll() : camera.frame(worldBoxOf(box), aspect());
}

void Session::addCamera() {
    if (!shown_) return;
    const ViewCamera& view = camera.camera();
    std::vector<Camera> cameras = composer.editor.scene().cameras;
    cameras.push_back({.name = "view " + std::to_string(cameras.size() + 1),
                       .position = view.position,
                       .target = view.target,
                       .fovYDegrees = view.fovYDegrees});
    composer.tell(composer.editor.setCameras(std::move(cameras)));
}

// ---- Commands --------------------------------------------------------------------------------------------

void Session::changeSelected(const std::function<SceneModel(const SceneModel&, const WorldBounds&)>& change) {
    SceneEditor& editor = composer.editor;
    if (!shown_ || !editor.selected()) return;
    const WorldBounds box = boundsOfModel(shown_->loaded, *editor.selected());
    composer.tell(editor.setModel(*editor.selected(), change(*editor.selectedModel(), box)));
}

void Session::moveSelected(MoveDirection direction) {
    if (!shown_) return;
    const double step = voxelMetresOf(shown_->loaded);
    changeSelected([&](SceneModel model, const WorldBounds&) {
        model.translateMetres += step * vectorOf(direction);
        return model;
    });
}

double Session::fileVoxelOfSelected() const {
    for (const PlacedAsset& part : shown_->loaded.parts) {
        if (part.model == composer.editor.selected()) return part.asset->source.voxelSizeMetres;
    }
    return 1.0;
}

void Session::executeEdit(const KeyBinding& binding) {
    SceneEditor& editor = composer.editor;
    switch (binding.command) {
        case Command::NewScene:
            return newScene();
        case Command::Open:
            composer.dialog = Dialog::Open;
            return;
        case Command::AddModel:
            composer.dialog = Dialog::AddModel;
            return;
        case Command::Save:
            if (shown_) composer.save();
            return;
        case Command::SaveAs:
            if (shown_) composer.dialog = Dialog::SaveAs;
            return;
        case Command::Undo:
            editor.undo();
            return;
        case Command::Redo:
            editor.redo();
            return;
        case Command::Duplicate:
            if (shown_) composer.duplicateSelected(shown_->loaded);
            return;
        case Command::Remove:
            return composer.removeSelected();
        case Command::SelectNext:
            return editor.selectNext(binding.argument);
        case Command::Move:
            return moveSelected(static_cast<MoveDirection>(binding.argument));
        case Command::Turn:
            return changeSelected([&](const SceneModel& model, const WorldBounds& box) {
                return turnedAbout(model, footOf(box), glm::radians(static_cast<double>(binding.argument)));
            });
        case Command::Resize:
            return changeSelected([&](const SceneModel& model, const WorldBounds& box) {
                return resized(model, {.factor = binding.argument > 0 ? kResizeFactor : 1.0 / kResizeFactor,
                                       .center = footOf(box),
                                       .voxelMetres = fileVoxelOfSelected()});
            });
        case Command::FrameSelected:
            return frameSelected();
        case Command::ToggleProbeGrid:
            settings.showProbeGrid = !settings.showProbeGrid;
            return;
        case Command::ToggleBounds:
            settings.showBounds = !settings.showBounds;
            return;
        default:
            return;
    }
}

}  // namespace pfvox::viewer
