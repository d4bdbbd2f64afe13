// Widgets: the few things that all panels are made of.
#pragma once

#include <imgui.h>

#include <cstdint>
#include <glm/glm.hpp>
#include <string>

#include "input.hpp"

namespace pfvox::viewer {

inline constexpr float kMargin = 8.0f;
inline constexpr float kMenuHeight = 20.0f;
inline constexpr float kPanelWidth = 320.0f;

void text(const std::string& line);
/// Dimmer, for what explains.
void note(const std::string& line);
std::string bytesText(std::uint64_t bytes);
/// Three figures at least: "8.25 ms", "1075 ms", "15.6 s".
std::string millisecondsText(double ms);

/// Begins a panel at its first place; flags keep it from taking the keys away when it appears.
bool beginPanel(const char* title, bool& open, ImVec2 at, ImVec2 size);

/// A slider for a double.
bool slider(const char* label, double& value, double low, double high, const char* format);

/// How a field of numbers is dragged.
struct DragRange {
    float speed = 0.01f;
    double low = -1e9;
    double high = 1e9;
    const char* format = "%.3f";
};
/// Right after a widget: when it was left, what the user does next is another step to undo. What `changed` in
/// this very frame, and is applied after this call, still belongs to the step: in a slow frame that is the
/// whole number with Return.
void endStep(bool changed, SceneEditor& editor);
/// True while the user changes it. The step to undo ends when the field is left.
bool dragVector(const char* label, glm::dvec3& value, const DragRange& range, SceneEditor& editor);
bool dragNumber(const char* label, double& value, const DragRange& range, SceneEditor& editor);
bool dragCounts(const char* label, glm::uvec3& value, std::uint32_t high, SceneEditor& editor);
bool editColor(const char* label, glm::dvec3& value, SceneEditor& editor);

/// A button or menu item that does what a key does.
bool commandButton(Input& input, const char* label, Command command);
void commandItem(Input& input, const char* label, Command command, bool enabled = true, bool checked = false);

/// Pixels as a square of the given edge, with a name under it.
void drawSmallMap(const char* label, std::uint32_t resolution, const std::vector<std::uint32_t>& pixels,
                  float size);

}  // namespace pfvox::viewer
