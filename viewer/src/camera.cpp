#include "camera.hpp"

#include <algorithm>
#include <cmath>

namespace pfvox::viewer {

CameraFrame frameOf(const ViewCamera& camera) {
    const glm::dvec3 toTarget = camera.target - camera.position;
    CameraFrame frame;
    if (glm::length(toTarget) > 0.0) frame.forward = glm::normalize(toTarget);
    const bool vertical = std::abs(frame.forward.y) > 1.0 - 1e-9;
    const glm::dvec3 about = vertical ? glm::dvec3(0.0, 0.0, -1.0) : glm::dvec3(0.0, 1.0, 0.0);
    frame.right = glm::normalize(glm::cross(frame.forward, about));
    frame.up = glm::cross(frame.right, frame.forward);
    return frame;
}

ViewCamera cameraFraming(const gpu::WorldBox& box, double aspect, double fovYDegrees) {
    constexpr double kMargin = 1.06;
    ViewCamera camera{.fovYDegrees = fovYDegrees};
    if (box.empty()) return camera;
    camera.target = 0.5 * (box.min + box.max);
    const glm::dvec3 backward = glm::normalize(glm::dvec3(0.62, 0.48, 1.0));
    camera.position = camera.target + backward;
    const CameraFrame frame = frameOf(camera);
    const double tanY = std::tan(glm::radians(0.5 * fovYDegrees));
    const double tanX = tanY * aspect;

    // The distance at which the last of the eight corners comes into the picture.
    double distance = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 p((corner & 1) != 0 ? box.max.x : box.min.x,
                           (corner & 2) != 0 ? box.max.y : box.min.y,
                           (corner & 4) != 0 ? box.max.z : box.min.z);
        const glm::dvec3 v = p - camera.target;
        const double needed =
            std::max(std::abs(glm::dot(v, frame.right)) / tanX, std::abs(glm::dot(v, frame.up)) / tanY);
        distance = std::max(distance, needed * kMargin + glm::dot(v, backward));
    }
    camera.position = camera.target + distance * backward;
    return camera;
}

}  // namespace pfvox::viewer
