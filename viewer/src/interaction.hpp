// Interaction: keys and mouse in, camera movement and commands out. Knows no window.
#pragma once

#include <optional>
#include <set>
#include <vector>

#include "camera_controller.hpp"
#include "commands.hpp"

namespace pfvox::viewer {

enum class MouseButton : std::uint8_t { Left, Right, Middle };

class Interaction {
  public:
    explicit Interaction(CameraController& camera) : camera_(&camera) {}

    /// Of the window, in the unit of cursor positions.
    void setSize(glm::dvec2 size) { size_ = glm::max(size, glm::dvec2(1.0)); }

    void key(Key key, bool pressed, bool control);
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

  private:
    glm::dvec3 heldDirection() const;

    CameraController* camera_;
    glm::dvec2 size_{1.0};
    glm::dvec2 cursor_{0.0};
    glm::dvec2 pressedAt_{0.0};
    std::optional<MouseButton> held_;
    bool dragging_ = false;
    std::set<Key> keys_;
    std::vector<KeyBinding> commands_;
    std::optional<glm::dvec2> click_;
};

}  // namespace pfvox::viewer
