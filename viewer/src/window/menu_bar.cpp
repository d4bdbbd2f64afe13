// The menu: everything that keys do, and the windows.
#include <fmt/format.h>
#include <imgui.h>

#include "window/panels.hpp"
#include "window/widgets.hpp"

namespace pfvox::viewer {

namespace {

void drawFileMenu(Session& session) {
    const bool shown = session.document.shown() != nullptr;
    commandItem(session.input, "New scene", Command::NewScene);
    commandItem(session.input, "Open ...", Command::Open);
    commandItem(session.input, "Add model ...", Command::AddModel);
    if (ImGui::MenuItem("Load probes ...", nullptr, false, shown))
        session.document.composer.dialog = Dialog::LoadProbes;
    ImGui::Separator();
    commandItem(session.input, "Save", Command::Save, shown);
    commandItem(session.input, "Save as ...", Command::SaveAs, shown);
    commandItem(session.input, "Read again", Command::Reload, shown);
    commandItem(session.input, "Next file", Command::NextFile, shown);
    commandItem(session.input, "Previous file", Command::PreviousFile, shown);
    commandItem(session.input, "Screenshot", Command::Screenshot, shown);
    ImGui::Separator();
    commandItem(session.input, "Quit", Command::Quit);
}

void drawEditMenu(Session& session) {
    SceneEditor& editor = session.document.composer.editor;
    const auto named = [](const char* verb, std::string_view what) {
        return what.empty() ? std::string(verb) : fmt::format("{} {}", verb, what);
    };
    commandItem(session.input, named("Undo", editor.undoText()).c_str(), Command::Undo, editor.canUndo());
    commandItem(session.input, named("Redo", editor.redoText()).c_str(), Command::Redo, editor.canRedo());
    ImGui::Separator();
    const bool selected = editor.selected().has_value();
    commandItem(session.input, "Duplicate", Command::Duplicate, selected);
    commandItem(session.input, "Remove", Command::Remove, selected);
    commandItem(session.input, "Select next", Command::SelectNext, !editor.scene().models.empty());
    if (ImGui::MenuItem("Select nothing", "Esc", false, selected)) editor.select(std::nullopt);
    if (ImGui::MenuItem("Camera from this view", nullptr, false, session.document.shown() != nullptr))
        session.input.addCamera();
}

void drawViewMenu(Session& session) {
    commandItem(session.input, "Frame everything", Command::FrameAll);
    commandItem(session.input, "Frame selected", Command::FrameSelected,
                session.document.composer.editor.selected().has_value());
    commandItem(session.input, "Fly", Command::ToggleCameraMode, true,
                session.view.camera.mode == CameraMode::Fly);
    commandItem(session.input, "Next camera", Command::NextCamera);
    ImGui::Separator();
    commandItem(session.input, "Probe grid", Command::ToggleProbeGrid, true,
                session.view.settings.showProbeGrid);
    commandItem(session.input, "Boxes of models", Command::ToggleBounds, true,
                session.view.settings.showBounds);
    ImGui::Separator();
    for (const ViewEntry& view : viewModes()) {
        const bool chosen = ImGui::MenuItem(std::string(view.name).c_str(), std::string(view.keyText).c_str(),
                                            session.view.mode == view.mode);
        if (chosen) session.input.execute(*bindingOf(Command::ShowView, static_cast<int>(view.mode)));
    }
}

}  // namespace

void Panels::drawMenuBar(Session& session) {
    if (!ImGui::BeginMainMenuBar()) return;
    if (ImGui::BeginMenu("File")) {
        drawFileMenu(session);
        ImGui::EndMenu();
    }
    if (ImGui::BeginMenu("Edit")) {
        drawEditMenu(session);
        ImGui::EndMenu();
    }
    if (ImGui::BeginMenu("View")) {
        drawViewMenu(session);
        ImGui::EndMenu();
    }
    if (ImGui::BeginMenu("Windows")) {
        ImGui::MenuItem("Scene", nullptr, &sceneOpen_);
        ImGui::MenuItem("Rendering", nullptr, &renderingOpen_);
        ImGui::MenuItem("Statistics", nullptr, &statisticsOpen_);
        ImGui::MenuItem("Probes", nullptr, &probesOpen_);
        ImGui::MenuItem("Log", nullptr, &logOpen_);
        commandItem(session.input, "Hide all", Command::ToggleWindows);
        ImGui::EndMenu();
    }
    if (ImGui::BeginMenu("Help")) {
        commandItem(session.input, "Keys", Command::ToggleHelp, true, session.view.showHelp);
        ImGui::EndMenu();
    }
    ImGui::EndMainMenuBar();
}

}  // namespace pfvox::viewer
