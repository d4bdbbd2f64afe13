// Interaction: keys and mouse in, camera movement and commands out. Knows no window.
#pragma once

#include <functional>
#include <optional>
#include <set>
#include <vector>

#include "camera_controller.hpp"
#include "commands.hpp"

namespace pfvox::viewer {

enum class MouseButton : std::uint8_t { Left, Right, Middle };

/// Something that the left button holds, from where it went down; points as parts of the window from its
/// upper left.
struct Drag {
    glm::dvec2 to{0.0};
    bool ended = false;
};

class Interaction {
  public:
    explicit Interaction(CameraController& camera) : camera_(&camera) {}

    /// Whether a press of the left button there takes hold of something; the drag then moves that, not the
    /// camera.
    std::function<bool(glm::dvec2 parts)> grabs = [](glm::dvec2) { return false; };

    /// Of the window, in the unit of cursor positions.
    void setSize(glm::dvec2 size) { size_ = glm::max(size, glm::dvec2(1.0)); }

    void key(Key key, bool pressed, bool control, bool shift = false);
    void cursor(glm::dvec2 position);
    void button(MouseButton button, bool pressed);
    void wheel(double notches) { camera_->wheel(notches); }
    /// All keys and buttons are up: the window lost the focus.
    void release();
    /// Moves the camera by the keys that are held.
    void advance(double seconds);
    bool isMoving() const { return glm::length(heldDirection()) > 0.0; }

    /// Bindings whose keys were pressed since the last call, in order.
    std::vector<KeyBinding> takeCommands();
    /// Where was clicked without dragging since the last call, as parts of the window from its upper left.
    std::optional<glm::dvec2> takeClick();
    /// Where what was taken hold of has been dragged since the last call.
    std::optional<Drag> takeDrag();
    glm::dvec2 cursorParts() const { return cursor_ / size_; }

  private:
    glm::dvec3 heldDirection() const;
    void letGo();

    CameraController* camera_;
    glm::dvec2 size_{1.0};
    glm::dvec2 cursor_{0.0};
    glm::dvec2 pressedAt_{0.0};
    std::optional<MouseButton> held_;
    bool dragging_ = false;
    bool grabbed_ = false;
    std::optional<Drag> drag_;
    std::set<Key> keys_;
    std::vector<KeyBinding> commands_;
    std::optional<glm::dvec2> click_;
};

}  // namespace pfvox::viewer
