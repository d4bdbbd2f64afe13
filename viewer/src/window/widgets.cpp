#include "window/widgets.hpp"

#include <fmt/format.h>

namespace pfvox::viewer {

void endStep(bool changed, SceneEditor& editor) {
    if (!ImGui::IsItemDeactivated()) return;
    changed ? editor.endGestureAfterNextEdit() : editor.endGesture();
}

void text(const std::string& line) {
    ImGui::TextUnformatted(line.c_str(), line.c_str() + line.size());
}

void note(const std::string& line) {
    ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
    ImGui::PushTextWrapPos(0.0f);
    text(line);
    ImGui::PopTextWrapPos();
    ImGui::PopStyleColor();
}

std::string bytesText(std::uint64_t bytes) {
    const auto value = static_cast<double>(bytes);
    if (bytes < 1u << 20) return fmt::format("{:.1f} KiB", value / 1024.0);
    return bytes < 1u << 30 ? fmt::format("{:.1f} MiB", value / 1048576.0)
                            : fmt::format("{:.2f} GiB", value / 1073741824.0);
}

std::string millisecondsText(double ms) {
    if (ms >= 10e3) return fmt::format("{:.1f} s", 1e-3 * ms);
    return fmt::format("{:.{}f} ms", ms, ms < 10.0 ? 2 : ms < 100.0 ? 1 : 0);
}

bool beginPanel(const char* title, bool& open, ImVec2 at, ImVec2 size) {
    // Until the user chooses others.
    ImGui::SetNextWindowPos(at, ImGuiCond_FirstUseEver);
    ImGui::SetNextWindowSize(size, ImGuiCond_FirstUseEver);
    return ImGui::Begin(title, &open, ImGuiWindowFlags_NoFocusOnAppearing);
}

bool slider(const char* label, double& value, double low, double high, const char* format) {
    return ImGui::SliderScalar(label, ImGuiDataType_Double, &value, &low, &high, format,
                               ImGuiSliderFlags_AlwaysClamp);
}

bool dragVector(const char* label, glm::dvec3& value, const DragRange& range, SceneEditor& editor) {
    const bool changed = ImGui::DragScalarN(label, ImGuiDataType_Double, &value.x, 3, range.speed, &range.low,
                                            &range.high, range.format, ImGuiSliderFlags_AlwaysClamp);
    endStep(changed, editor);
    return changed;
}

bool dragNumber(const char* label, double& value, const DragRange& range, SceneEditor& editor) {
    const bool changed = ImGui::DragScalar(label, ImGuiDataType_Double, &value, range.speed, &range.low,
                                           &range.high, range.format, ImGuiSliderFlags_AlwaysClamp);
    endStep(changed, editor);
    return changed;
}

bool dragCounts(const char* label, glm::uvec3& value, std::uint32_t high, SceneEditor& editor) {
    const std::uint32_t low = 1;
    const bool changed = ImGui::DragScalarN(label, ImGuiDataType_U32, &value.x, 3, 0.1f, &low, &high, "%u",
                                            ImGuiSliderFlags_AlwaysClamp);
    endStep(changed, editor);
    return changed;
}

bool editColor(const char* label, glm::dvec3& value, SceneEditor& editor) {
    glm::vec3 color(value);
    const bool changed =
        ImGui::ColorEdit3(label, &color.x, ImGuiColorEditFlags_HDR | ImGuiColorEditFlags_Float);
    endStep(changed, editor);
    if (changed) value = glm::max(glm::dvec3(color), glm::dvec3(0.0));
    return changed;
}

bool commandButton(Input& input, const char* label, Command command) {
    const KeyBinding* const binding = bindingOf(command);
    const bool pressed = ImGui::Button(label);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", std::string(binding->keyText).c_str());
    if (pressed) input.execute(*binding);
    return pressed;
}

void commandItem(Input& input, const char* label, Command command, bool enabled, bool checked) {
    const KeyBinding* const binding = bindingOf(command);
    if (ImGui::MenuItem(label, std::string(binding->keyText).c_str(), checked, enabled))
        input.execute(*binding);
}

void drawSmallMap(const char* label, std::uint32_t resolution, const std::vector<std::uint32_t>& pixels,
                  float size) {
    if (resolution == 0) return;
    ImGui::BeginGroup();
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    ImDrawList* const list = ImGui::GetWindowDrawList();
    const float step = size / static_cast<float>(resolution);
    for (std::uint32_t i = 0; i < pixels.size(); ++i) {
        const ImVec2 at(corner.x + step * static_cast<float>(i % resolution),
                        corner.y + step * static_cast<float>(i / resolution));
        list->AddRectFilled(at, {at.x + step, at.y + step}, pixels[i]);
    }
    ImGui::Dummy({size, size});
    text(label);
    ImGui::EndGroup();
}

}  // namespace pfvox::viewer
