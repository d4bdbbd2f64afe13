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
inline constexpr Key kKeyLeft = 261;
inline constexpr Key kKeyRight = 262;
inline constexpr Key kKeyUp = 263;
inline constexpr Key kKeyDown = 264;
inline constexpr Key kKeyInsert = 265;
inline constexpr Key kKeyDelete = 266;
inline constexpr Key kKeyOther = -1;
/// Held down, they count again and again.
constexpr bool repeats(Key key) {
    return key >= kKeyLeft && key <= kKeyDown;
}

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
    DismissMessage,  ///< then select nothing
    Quit,
    // Composing
    NewScene,
    Open,
    Save,
    SaveAs,
    AddModel,
    Duplicate,
    Remove,
    Undo,
    Redo,
    SelectNext,  ///< argument: 1 or -1
    Move,        ///< argument: MoveDirection
    Turn,        ///< argument: degrees about the vertical
    Resize,      ///< argument: 1 larger, -1 smaller
    FrameSelected,
    ToggleProbeGrid,
    ToggleBounds,
};

/// Of the world; the argument of Command::Move.
enum class MoveDirection : unsigned char { Left, Right, Back, Front, Down, Up };

struct KeyBinding {
    Key key;
    bool control;
    Command command;
    int argument;
    std::string_view keyText;  ///< as written on the keyboard
    std::string_view what;
    bool shift = false;
};

std::span<const KeyBinding> keyBindings();
/// Shift is ignored where no binding asks for it.
const KeyBinding* bindingOf(Key key, bool control, bool shift = false);
/// The first binding of a command (with this argument); null = it has no key.
const KeyBinding* bindingOf(Command command, std::optional<int> argument = {});

/// What the mouse and the keys that are held do, beside keyBindings().
struct HeldBinding {
    std::string_view keyText;
    std::string_view what;
};
std::span<const HeldBinding> heldBindings();

}  // namespace pfvox::viewer
