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

constexpr int direction(MoveDirection to) {
    return static_cast<int>(to);
}

constexpr std::array kComposing{
    KeyBinding{'N', true, Command::NewScene, 0, "Ctrl+N", "new scene"},
    KeyBinding{'O', true, Command::Open, 0, "Ctrl+O", "open"},
    KeyBinding{'S', true, Command::Save, 0, "Ctrl+S", "save the scene"},
    KeyBinding{'S', true, Command::SaveAs, 0, "Ctrl+Shift+S", "save it under another name", true},
    KeyBinding{'Z', true, Command::Undo, 0, "Ctrl+Z", "undo"},
    KeyBinding{'Z', true, Command::Redo, 0, "Ctrl+Shift+Z", "redo", true},
    KeyBinding{'Y', true, Command::Redo, 0, "Ctrl+Y", "redo"},
    KeyBinding{kKeyInsert, false, Command::AddModel, 0, "Insert", "add a model"},
    KeyBinding{'D', true, Command::Duplicate, 0, "Ctrl+D", "duplicate the selected model"},
    KeyBinding{kKeyDelete, false, Command::Remove, 0, "Delete", "remove it"},
    KeyBinding{'N', false, Command::SelectNext, 1, "N", "select the next model"},
    KeyBinding{'N', false, Command::SelectNext, -1, "Shift+N", "select the one before", true},
    KeyBinding{kKeyLeft, false, Command::Move, direction(MoveDirection::Left), "Left",
               "move it by a voxel: -X"},
    KeyBinding{kKeyRight, false, Command::Move, direction(MoveDirection::Right), "Right", "+X"},
    KeyBinding{kKeyUp, false, Command::Move, direction(MoveDirection::Back), "Up", "-Z"},
    KeyBinding{kKeyDown, false, Command::Move, direction(MoveDirection::Front), "Down", "+Z"},
    KeyBinding{kKeyUp, false, Command::Move, direction(MoveDirection::Up), "Shift+Up", "+Y", true},
    KeyBinding{kKeyDown, false, Command::Move, direction(MoveDirection::Down), "Shift+Down", "-Y", true},
    KeyBinding{kKeyLeft, true, Command::Turn, 15, "Ctrl+Left", "turn it by 15 degrees"},
    KeyBinding{kKeyRight, true, Command::Turn, -15, "Ctrl+Right", "the other way"},
    KeyBinding{kKeyUp, true, Command::Resize, 1, "Ctrl+Up", "a tenth larger"},
    KeyBinding{kKeyDown, true, Command::Resize, -1, "Ctrl+Down", "smaller"},
    KeyBinding{'F', false, Command::FrameSelected, 0, "Shift+F", "frame the selected model", true},
    KeyBinding{'G', false, Command::ToggleProbeGrid, 0, "G", "show or hide the probe grid"},
    KeyBinding{'B', false, Command::ToggleBounds, 0, "B", "show or hide the models' boxes"},
};

constexpr std::array kHeld{
    HeldBinding{"left drag", "turn about the target, or look about when flying"},
    HeldBinding{"right or middle drag", "shift the view"},
    HeldBinding{"wheel", "closer or farther; when flying: faster or slower"},
    HeldBinding{"click", "tell the voxel under the cursor, select its model or a probe"},
    HeldBinding{"drag a handle", "move or turn the selected model"},
    HeldBinding{"W A S D", "move forward, left, back, right"},
    HeldBinding{"E Q", "move up, down"},
    HeldBinding{"Shift", "move five times as fast"},
    HeldBinding{"drop files", "open them; models come to the scene that is open"},
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
    all.insert(all.end(), kComposing.begin(), kComposing.end());
    return all;
}

}  // namespace

std::span<const KeyBinding> keyBindings() {
    static const std::vector<KeyBinding> kAll = allBindings();
    return kAll;
}

const KeyBinding* bindingOf(Key key, bool control, bool shift) {
    const KeyBinding* found = nullptr;
    for (const KeyBinding& binding : keyBindings()) {
        if (binding.key != key || binding.control != control) continue;
        if (binding.shift == shift) return &binding;
        if (!binding.shift) found = &binding;
    }
    return found;
}

const KeyBinding* bindingOf(Command command, std::optional<int> argument) {
    for (const KeyBinding& binding : keyBindings()) {
        if (binding.command == command && (!argument || binding.argument == *argument)) return &binding;
    }
    return nullptr;
}

std::span<const HeldBinding> heldBindings() {
    return kHeld;
}

}  // namespace pfvox::viewer
