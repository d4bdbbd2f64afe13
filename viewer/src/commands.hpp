// Commands: what keys do in the window, in one table that the program, its help and the tests share.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace pfvox::viewer {

/// Letters, digits and signs are their upper-case ASCII; the others follow.
using Key = int;
inline constexpr Key kKeyTab = 256;
inline constexpr Key kKeyEscape = 257;
inline constexpr Key kKeyPageUp = 258;
inline constexpr Key kKeyPageDown = 259;
inline constexpr Key kKeyShift = 260;
inline constexpr Key kKeyOther = -1;

enum class Command : unsigned char {
    FrameAll,
    ToggleHelp,
    ToggleWindows,
    ToggleCameraMode,
    NextCamera,
    ShowView,  ///< argument: ViewMode
    Screenshot,
    Reload,
    NextFile,
    PreviousFile,
    DismissMessage,
    Quit,
};

struct KeyBinding {
    Key key;
    bool control;
    Command command;
    int argument;
    std::string_view keyText;  ///< as written on the keyboard
    std::string_view what;
};

std::span<const KeyBinding> keyBindings();
const KeyBinding* bindingOf(Key key, bool control);

/// What the mouse and the keys that are held do, beside keyBindings().
struct HeldBinding {
    std::string_view keyText;
    std::string_view what;
};
std::span<const HeldBinding> heldBindings();

}  // namespace pfvox::viewer
