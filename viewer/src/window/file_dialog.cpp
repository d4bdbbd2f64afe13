#include "window/file_dialog.hpp"

#include <imgui.h>
#include <imgui_stdlib.h>

#include <system_error>

#include "window/widgets.hpp"

namespace pfvox::viewer {

namespace fs = std::filesystem;

void FileDialog::begin(const fs::path& folder, const std::string& name) {
    folder_ = folder;
    path_ = name;
    error_.clear();
    begun_ = true;
    wantsKeys_ = true;
    listed_ = false;
}

void FileDialog::list(const fs::path& folder, const Request& request) {
    Result<FileList> files = listFiles(folder, request.extensions);
    listed_ = true;
    if (!files) {
        error_ = describe(files.error());
        return;
    }
    files_ = *std::move(files);
    folder_ = files_.folder;
    error_.clear();
}

/// A folder is gone into, a file is taken.
bool FileDialog::accept(const Request& request) {
    if (path_.empty()) return false;
    const fs::path path = folder_ / fs::path(path_);
    std::error_code ignored;
    if (fs::is_directory(path, ignored)) {
        path_.clear();
        list(path, request);
        return false;
    }
    if (!request.forWriting && !fs::exists(path, ignored)) {
        error_ = "there is no such file";
        return false;
    }
    chosen_ = path.lexically_normal();
    return true;
}

bool FileDialog::drawList(const Request& request) {
    bool taken = false;
    std::optional<std::string> entered;
    if (ImGui::BeginChild("files", {0.0f, -2.2f * ImGui::GetFrameHeightWithSpacing()}, true)) {
        if (ImGui::Selectable("..")) entered = "..";
        for (const std::string& name : files_.folders) {
            if (ImGui::Selectable((name + "/").c_str())) entered = name;
        }
        for (const std::string& name : files_.files) {
            if (ImGui::Selectable(name.c_str(), name == path_, ImGuiSelectableFlags_AllowDoubleClick)) {
                path_ = name;
                wantsKeys_ = true;
                taken = ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left) && accept(request);
            }
        }
        if (files_.files.empty()) note("no such files in this folder");
    }
    ImGui::EndChild();
    if (!entered) return taken;
    if (!request.forWriting) path_.clear();  // a name to save under is kept
    wantsKeys_ = true;
    list(folder_ / *entered, request);
    return taken;
}

FileDialog::State FileDialog::draw(const Request& request) {
    const ImVec2 window = ImGui::GetIO().DisplaySize;
    if (begun_) ImGui::OpenPopup(request.title);
    if (!listed_) list(folder_, request);
    ImGui::SetNextWindowPos({0.5f * window.x, 0.5f * window.y}, ImGuiCond_Appearing, {0.5f, 0.5f});
    ImGui::SetNextWindowSize({0.6f * window.x, 0.7f * window.y}, ImGuiCond_Appearing);
    State state = State::Open;
    if (!ImGui::BeginPopupModal(request.title, nullptr, ImGuiWindowFlags_NoSavedSettings)) {
        begun_ = false;
        return State::Cancelled;
    }
    note(folder_.string());
    begun_ = false;
    if (std::exchange(wantsKeys_, false)) ImGui::SetKeyboardFocusHere();
    ImGui::SetNextItemWidth(-1.0f);
    if (ImGui::InputText("##path", &path_, ImGuiInputTextFlags_EnterReturnsTrue)) {
        if (accept(request)) state = State::Chosen;
        wantsKeys_ = state == State::Open;  // Return takes them from the field
    }
    if (drawList(request)) state = State::Chosen;
    std::error_code ignored;
    const bool replaces =
        request.forWriting && !path_.empty() && fs::is_regular_file(folder_ / fs::path(path_), ignored);
    note(!error_.empty() ? error_ : replaces ? "replaces the file that is there" : " ");
    if (ImGui::Button(request.button) && accept(request)) state = State::Chosen;
    ImGui::SameLine();
    if (ImGui::Button("Cancel") || ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape), false))
        state = State::Cancelled;
    if (state != State::Open) ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
    return state;
}

}  // namespace pfvox::viewer
