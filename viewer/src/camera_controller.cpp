#include "camera_controller.hpp"

#include <algorithm>
#include <cmath>

namespace pfvox::viewer {

namespace {

constexpr double kRadiansPerHeight = 3.5;  // of turning, for a drag over the whole picture
constexpr double kSteepest = 1.55;         // radians: straight up and down have no yaw
constexpr double kFasterFactor = 5.0;
constexpr double kNotchFactor = 0.85;
constexpr double kNearest = 1e-4;  // metres to the target

}  // namespace

void CameraController::suit(const gpu::WorldBox& box) {
    if (!box.empty()) speed = std::max(0.2 * glm::length(box.max - box.min), 1e-3);
}

void CameraController::frame(const gpu::WorldBox& box, double aspect) {
    camera_ = cameraFraming(box, aspect, camera_.fovYDegrees);
    suit(box);
}

void CameraController::lookAlong(double yaw, double pitch) {
    const double distance = glm::length(camera_.target - camera_.position);
    const glm::dvec3 forward(std::cos(pitch) * std::sin(yaw), std::sin(pitch),
                             -std::cos(pitch) * std::cos(yaw));
    if (mode == CameraMode::Orbit) {
        camera_.position = camera_.target - distance * forward;
    } else {
        camera_.target = camera_.position + distance * forward;
    }
}

void CameraController::turn(glm::dvec2 parts) {
    const glm::dvec3 forward = frameOf(camera_).forward;
    const double pitch = std::asin(std::clamp(forward.y, -1.0, 1.0));
    const double yaw = std::atan2(forward.x, -forward.z);
    // Orbiting, the scene follows the cursor, so the camera goes the other way; flying, the look follows it.
    // Both are the same turn.
    const glm::dvec2 angles = kRadiansPerHeight * parts;
    lookAlong(yaw + angles.x, std::clamp(pitch - angles.y, -kSteepest, kSteepest));
}

void CameraController::pan(glm::dvec2 parts) {
    const CameraFrame frame = frameOf(camera_);
    const double distance = glm::length(camera_.target - camera_.position);
    const double height = 2.0 * distance * std::tan(glm::radians(0.5 * camera_.fovYDegrees));
    const glm::dvec3 shift = height * (parts.y * frame.up - parts.x * frame.right);
    camera_.position += shift;
    camera_.target += shift;
}

void CameraController::wheel(double notches) {
    const double factor = std::pow(kNotchFactor, std::clamp(notches, -50.0, 50.0));
    if (mode == CameraMode::Fly) {
        speed = std::clamp(speed / factor, 1e-4, 1e6);
        return;
    }
    const glm::dvec3 backward = camera_.position - camera_.target;
    const double distance = std::max(glm::length(backward) * factor, kNearest);
    camera_.position = camera_.target - distance * frameOf(camera_).forward;
}

void CameraController::move(glm::dvec3 direction, double seconds, bool fast) {
    if (glm::length(direction) == 0.0) return;
    const CameraFrame frame = frameOf(camera_);
    const glm::dvec3 along =
        direction.x * frame.right + glm::dvec3(0.0, direction.y, 0.0) + direction.z * frame.forward;
    if (glm::length(along) == 0.0) return;
    const glm::dvec3 shift = speed * (fast ? kFasterFactor : 1.0) * seconds * glm::normalize(along);
    camera_.position += shift;
    camera_.target += shift;
}

}  // namespace pfvox::viewer
