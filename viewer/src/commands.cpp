#include "commands.hpp"

#include <array>
#include <vector>

#include "view_modes.hpp"

namespace pfvox::viewer {

namespace {

constexpr std::array kOthers{
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

std::vector<KeyBinding> allBindings() {
    std::vector<KeyBinding> all;
    for (const ViewEntry& view : viewModes()) {
        all.push_back({.key = view.key,
                       .control = view.control,
                       .command = Command::ShowView,
                       .argument = static_cast<int>(view.mode),
                       .keyText = view.keyText,
                       .what = view.what});
    }
    all.insert(all.end(), kOthers.begin(), kOthers.end());
    return all;
}

}  // namespace

std::span<const KeyBinding> keyBindings() {
    static const std::vector<KeyBinding> kAll = allBindings();
    return kAll;
}

const KeyBinding* bindingOf(Key key, bool control) {
    for (const KeyBinding& binding : keyBindings()) {
        if (binding.key == key && binding.control == control) return &binding;
    }
    return nullptr;
}

std::span<const HeldBinding> heldBindings() {
    return kHeld;
}

}  // namespace pfvox::viewer
