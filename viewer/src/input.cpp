#include "input.hpp"

#include "compose/model_edits.hpp"

namespace pfvox::viewer {

namespace {

constexpr double kResizeFactor = 1.1;

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

// ---- Commands --------------------------------------------------------------------------------------------

void Input::execute(const KeyBinding& binding) {
    if (document_->composer.waits()) return;
    switch (binding.command) {
        case Command::FrameAll:
            return view_->frameAll();
        case Command::FrameSelected:
            return view_->frameSelected();
        case Command::ToggleHelp:
            view_->showHelp = !view_->showHelp;
            return;
        case Command::ToggleWindows:
            view_->settings.showWindows = !view_->settings.showWindows;
            return;
        case Command::ToggleProbeGrid:
            view_->settings.showProbeGrid = !view_->settings.showProbeGrid;
            return;
        case Command::ToggleBounds:
            view_->settings.showBounds = !view_->settings.showBounds;
            return;
        case Command::ToggleCameraMode:
            view_->camera.mode =
                view_->camera.mode == CameraMode::Orbit ? CameraMode::Fly : CameraMode::Orbit;
            return;
        case Command::NextCamera:
            return view_->nextCamera();
        case Command::ShowView:
            return view_->setMode(static_cast<ViewMode>(binding.argument));
        case Command::Screenshot:
            return view_->writeScreenshot(screenshotFolder_);
        case Command::Reload:
            return document_->composer.leave([this] { document_->reload(); });
        case Command::NextFile:
            return document_->openNeighbor(1);
        case Command::PreviousFile:
            return document_->openNeighbor(-1);
        case Command::DismissMessage:
            if (!document_->log().strip()) document_->composer.editor.select(std::nullopt);
            return document_->log().dismissStrip();
        case Command::NewScene:
            return document_->newScene();
        case Command::Quit:
            return quit();
        default:
            return executeEdit(binding);
    }
}

void Input::executeEdit(const KeyBinding& binding) {
    Composer& composer = document_->composer;
    const ShownScene* const shown = document_->shown();
    switch (binding.command) {
        case Command::Open:
            composer.dialog = Dialog::Open;
            return;
        case Command::AddModel:
            composer.dialog = Dialog::AddModel;
            return;
        case Command::Save:
            if (shown != nullptr) composer.save();
            return;
        case Command::SaveAs:
            if (shown != nullptr) composer.dialog = Dialog::SaveAs;
            return;
        case Command::Undo:
            composer.editor.undo();
            return;
        case Command::Redo:
            composer.editor.redo();
            return;
        case Command::Duplicate:
            if (shown != nullptr) composer.duplicateSelected(shown->loaded);
            return;
        case Command::Remove:
            return composer.removeSelected();
        case Command::SelectNext:
            return composer.editor.selectNext(binding.argument);
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
                                       .voxelMetres = document_->fileVoxelOfSelected()});
            });
        default:
            return;
    }
}

void Input::changeSelected(const std::function<SceneModel(const SceneModel&, const WorldBounds&)>& change) {
    Composer& composer = document_->composer;
    const SceneEditor& editor = composer.editor;
    if (document_->shown() == nullptr || !editor.selected()) return;
    const WorldBounds box = boundsOfModel(document_->shown()->loaded, *editor.selected());
    composer.tell(composer.editor.setModel(*editor.selected(), change(*editor.selectedModel(), box)));
}

void Input::moveSelected(MoveDirection direction) {
    if (document_->shown() == nullptr) return;
    const double step = voxelMetresOf(document_->shown()->loaded);
    changeSelected([&](SceneModel model, const WorldBounds&) {
        model.translateMetres += step * vectorOf(direction);
        return model;
    });
}

void Input::addCamera() {
    if (document_->shown() == nullptr) return;
    const ViewCamera& view = view_->camera.camera();
    Composer& composer = document_->composer;
    std::vector<Camera> cameras = composer.editor.scene().cameras;
    cameras.push_back({.name = "view " + std::to_string(cameras.size() + 1),
                       .position = view.position,
                       .target = view.target,
                       .fovYDegrees = view.fovYDegrees});
    composer.tell(composer.editor.setCameras(std::move(cameras)));
}

void Input::quit() {
    document_->composer.leave([this] { quit_ = true; });
}

// ---- The mouse -------------------------------------------------------------------------------------------

void Input::clickAt(glm::dvec2 parts) {
    if (!view_->selectProbeAt(parts)) view_->pickAt(parts);
}

bool Input::grabAt(glm::dvec2 parts) {
    const std::optional<Gizmo> handles = view_->gizmo();
    if (!handles) return false;
    const glm::dvec2 at = parts * view_->windowSize;
    const std::optional<Handle> handle = handles->handleAt(at);
    if (!handle) return false;
    SceneEditor& editor = document_->composer.editor;
    editor.endGesture();
    drag_.emplace(editor, *handles, *handle, at);
    return true;
}

void Input::drag(const Drag& drag) {
    if (!drag_) return;
    Composer& composer = document_->composer;
    composer.tell(drag_->moveTo(drag.to * view_->windowSize, composer.editor));
    if (!drag.ended) return;
    drag_.reset();
    composer.editor.endGesture();
}

}  // namespace pfvox::viewer
