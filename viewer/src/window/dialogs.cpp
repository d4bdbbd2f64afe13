// What the window asks: for files, and whether changes are to be saved.
#include <fmt/format.h>
#include <imgui.h>

#include "window/panels.hpp"
#include "window/widgets.hpp"

namespace pfvox::viewer {

namespace {

namespace fs = std::filesystem;

FileDialog::Request requestOf(Dialog dialog) {
    switch (dialog) {
        case Dialog::Open:
            return {.title = "Open", .button = "Open", .extensions = {".toml", ".pf_vox", ".pf_probe"}};
        case Dialog::AddModel:
            return {.title = "Add a model", .button = "Add", .extensions = {".pf_vox"}};
        case Dialog::SaveAs:
            return {
                .title = "Save the scene as", .button = "Save", .extensions = {".toml"}, .forWriting = true};
        default:
            return {.title = "Probes", .button = "Load", .extensions = {".pf_probe"}};
    }
}

fs::path folderOf(const Document& document) {
    const fs::path folder = document.composer.editor.folder();
    return folder.empty() ? fs::path(".") : folder;
}

std::string nameToBeginWith(const Document& document, Dialog dialog) {
    if (dialog != Dialog::SaveAs) return {};
    const fs::path& file = document.composer.editor.file();
    return file.empty() ? "scene.toml" : file.filename().string();
}

void doWith(Document& document, Dialog dialog, const fs::path& file) {
    switch (dialog) {
        case Dialog::Open:
            return document.open(file);
        case Dialog::AddModel:
            return document.addModels({file});
        case Dialog::SaveAs:
            document.composer.saveAs(file);
            return;
        case Dialog::LoadProbes:
            return document.loadProbes(file);
        case Dialog::None:
            return;
    }
}

}  // namespace

void Panels::drawDialogs(Document& document) {
    Dialog& wanted = document.composer.dialog;
    if (wanted == Dialog::None) return drawLeaveQuestion(document.composer);
    if (!dialogShown_ || *dialogShown_ != wanted) {
        fileDialog_.begin(folderOf(document), nameToBeginWith(document, wanted));
        dialogShown_ = wanted;
    }
    const FileDialog::State state = fileDialog_.draw(requestOf(wanted));
    if (state == FileDialog::State::Open) return;
    const Dialog done = std::exchange(wanted, Dialog::None);
    dialogShown_.reset();
    if (state == FileDialog::State::Chosen) doWith(document, done, fileDialog_.chosen());
}

void drawLeaveQuestion(Composer& composer) {
    constexpr const char* kTitle = "Unsaved changes";
    if (!composer.isAsking()) return;
    const ImVec2 window = ImGui::GetIO().DisplaySize;
    if (!ImGui::IsPopupOpen(kTitle)) ImGui::OpenPopup(kTitle);
    ImGui::SetNextWindowPos({0.5f * window.x, 0.5f * window.y}, ImGuiCond_Appearing, {0.5f, 0.5f});
    if (!ImGui::BeginPopupModal(kTitle, nullptr,
                                ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings))
        return;
    const fs::path& file = composer.editor.file();
    text(fmt::format("Save the changes to {}?", file.empty() ? "the new scene" : file.filename().string()));
    const auto pressed = [](ImGuiKey key) { return ImGui::IsKeyPressed(ImGui::GetKeyIndex(key), false); };
    std::optional<Answer> answer;
    if (ImGui::Button("Save (Enter)") || pressed(ImGuiKey_Enter)) answer = Answer::Save;
    ImGui::SetItemDefaultFocus();
    ImGui::SameLine();
    if (ImGui::Button("Discard (Delete)") || pressed(ImGuiKey_Delete)) answer = Answer::Discard;
    ImGui::SameLine();
    if (ImGui::Button("Cancel (Esc)") || pressed(ImGuiKey_Escape)) answer = Answer::Cancel;
    if (answer) ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
    if (answer) composer.answer(*answer);
}

}  // namespace pfvox::viewer
