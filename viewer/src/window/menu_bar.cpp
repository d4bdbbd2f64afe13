// The menu: everything that keys do, and the windows.
#include <fmt/format.h>
#include <imgui.h>

#include "window/panels.hpp"
#include "window/widgets.hpp"

namespace pfvox::viewer {

namespace {

void drawFileMenu(Session& session) {
    const bool shown = session.shown() != nullptr;
    commandItem(session, "New scene", Command::NewScene);
    commandItem(session, "Open ...", Command::Open);
    commandItem(session, "Add model ...", Command::AddModel);
    if (ImGui::MenuItem("Load probes ...", nullptr, false, shown))
        session.composer.dialog = Dialog::LoadProbes;
    ImGui::Separator();
    commandItem(session, "Save", Command::Save, shown);
    commandItem(session, "Save as ...", Command::SaveAs, shown);
    commandItem(session, "Read again", Command::Reload, shown);
    commandItem(session, "Next file", Command::NextFile, shown);
    commandItem(session, "Previous file", Command::PreviousFile, shown);
    commandItem(session, "Screenshot", Command::Screenshot, shown);
    ImGui::Separator();
    commandItem(session, "Quit", Command::Quit);
}

void drawEditMenu(Session& session) {
    SceneEditor& editor = session.composer.editor;
    const auto named = [](const char* verb, std::string_view what) {
        return what.empty() ? std::string(verb) : fmt::format("{} {}", verb, what);
    };
    commandItem(session, named("Undo", editor.undoText()).c_str(), Command::Undo, editor.canUndo());
    commandItem(session, named("Redo", editor.redoText()).c_str(), Command::Redo, editor.canRedo());
    ImGui::Separator();
    const bool selected = editor.selected().has_value();
    commandItem(session, "Duplicate", Command::Duplicate, selected);
    commandItem(session, "Remove", Command::Remove, selected);
    commandItem(session, "Select next", Command::SelectNext, !editor.scene().models.empty());
    if (ImGui::MenuItem("Select nothing", "Esc", false, selected)) editor.select(std::nullopt);
    if (ImGui::MenuItem("Camera from this view", nullptr, false, session.shown() != nullptr))
        session.addCamera();
}

void drawViewMenu(Session& session) {
    commandItem(session, "Frame everything", Command::FrameAll);
    commandItem(session, "Frame selected", Command::FrameSelected,
                session.composer.editor.selected().has_value());
    commandItem(session, "Fly", Command::ToggleCameraMode, true, session.camera.mode == CameraMode::Fly);
    commandItem(session, "Next camera", Command::NextCamera);
    ImGui::Separator();
    commandItem(session, "Probe grid", Command::ToggleProbeGrid, true, session.settings.showProbeGrid);
    commandItem(session, "Boxes of models", Command::ToggleBounds, true, session.settings.showBounds);
    ImGui::Separator();
    for (const ViewEntry& view : viewModes()) {
        const bool chosen = ImGui::MenuItem(std::string(view.name).c_str(), std::string(view.keyText).c_str(),
                                            session.mode == view.mode);
        if (chosen) session.execute(*bindingOf(Command::ShowView, static_cast<int>(view.mode)));
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
        commandItem(session, "Hide all", Command::ToggleWindows);
        ImGui::EndMenu();
    }
    if (ImGui::BeginMenu("Help")) {
        commandItem(session, "Keys", Command::ToggleHelp, true, session.showHelp);
        ImGui::EndMenu();
    }
    ImGui::EndMainMenuBar();
}

}  // namespace pfvox::viewer
