#include "commands.hpp"

#include <array>

namespace pfvox::viewer {

namespace {

constexpr std::array kBindings{
    KeyBinding{'1', false, Command::ShowView, 0, "1", "final: sun with shadow, sky, emission"},
    KeyBinding{'2', false, Command::ShowView, 1, "2", "albedo"},
    KeyBinding{'3', false, Command::ShowView, 2, "3", "normals"},
    KeyBinding{'4', false, Command::ShowView, 3, "4", "material index"},
    KeyBinding{'5', false, Command::ShowView, 4, "5", "depth in the octree"},
    KeyBinding{'6', false, Command::ShowView, 5, "6", "traversal steps as a heat map"},
    KeyBinding{'7', false, Command::ShowView, 6, "7", "level of detail that was hit"},
    KeyBinding{'F', false, Command::FrameAll, 0, "F", "frame everything"},
    KeyBinding{'C', false, Command::ToggleCameraMode, 0, "C", "orbit or fly"},
    KeyBinding{'V', false, Command::NextCamera, 0, "V", "next camera of the scene"},
    KeyBinding{kKeyPageDown, false, Command::NextFile, 0, "Page Down", "next file of the folder"},
    KeyBinding{kKeyPageUp, false, Command::PreviousFile, 0, "Page Up", "previous file of the folder"},
    KeyBinding{'R', false, Command::Reload, 0, "R", "read the files again"},
    KeyBinding{'P', false, Command::Screenshot, 0, "P", "write a screenshot"},
    KeyBinding{kKeyTab, false, Command::ToggleWindows, 0, "Tab", "show or hide the windows"},
    KeyBinding{'H', false, Command::ToggleHelp, 0, "H", "show or hide the keys"},
    KeyBinding{kKeyEscape, false, Command::DismissMessage, 0, "Esc", "close the message"},
    KeyBinding{'Q', true, Command::Quit, 0, "Ctrl+Q", "quit"},
};

constexpr std::array kHeld{
    HeldBinding{"left drag", "turn about the target, or look about when flying"},
    HeldBinding{"right or middle drag", "shift the view"},
    HeldBinding{"wheel", "closer or farther; when flying: faster or slower"},
    HeldBinding{"click", "tell the voxel under the cursor"},
    HeldBinding{"W A S D", "move forward, left, back, right"},
    HeldBinding{"E Q", "move up, down"},
    HeldBinding{"Shift", "move five times as fast"},
    HeldBinding{"drop files", "open them"},
};

}  // namespace

std::span<const KeyBinding> keyBindings() {
    return kBindings;
}

const KeyBinding* bindingOf(Key key, bool control) {
    for (const KeyBinding& binding : kBindings) {
        if (binding.key == key && binding.control == control) return &binding;
    }
    return nullptr;
}

std::span<const HeldBinding> heldBindings() {
    return kHeld;
}

}  // namespace pfvox::viewer
