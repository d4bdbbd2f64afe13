// CameraController: how dragging, the wheel and keys move the viewer's camera. Knows no window.
#pragma once

#include "camera.hpp"

namespace pfvox::viewer {

enum class CameraMode : std::uint8_t {
    Orbit,  ///< dragging turns about the target
    Fly,    ///< dragging looks about
};

class CameraController {
  public:
    CameraMode mode = CameraMode::Orbit;
    /// Metres a second of move(), before it is made faster.
    double speed = 2.0;

    const ViewCamera& camera() const { return camera_; }
    void set(const ViewCamera& camera) { camera_ = camera; }
    /// The whole box in view (cameraFraming); the speed becomes one that suits its size.
    void frame(const gpu::WorldBox& box, double aspect);
    /// Only the speed: for a camera that comes from elsewhere.
    void suit(const gpu::WorldBox& box);

    /// By parts of the height of the picture: to the right and down is positive.
    void turn(glm::dvec2 parts);
    /// Shifts camera and target across the view, so that the target stays under the cursor.
    void pan(glm::dvec2 parts);
    /// Up (positive) comes closer to the target, or flies faster.
    void wheel(double notches);
    /// `direction`: right, up (of the world), forward.
    void move(glm::dvec3 direction, double seconds, bool fast);

  private:
    void lookAlong(double yaw, double pitch);

    ViewCamera camera_;
};

}  // namespace pfvox::viewer
