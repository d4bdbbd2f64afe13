#include "camera.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

namespace pfvox::viewer {

ViewCamera viewCameraOf(const Camera& camera) {
    return {.position = camera.position, .target = camera.target, .fovYDegrees = camera.fovYDegrees};
}

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

namespace {

std::array<glm::dvec3, 8> cornersOf(const gpu::WorldBox& box) {
    std::array<glm::dvec3, 8> corners;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        corners[i] = {(i & 1) != 0 ? box.max.x : box.min.x, (i & 2) != 0 ? box.max.y : box.min.y,
                      (i & 4) != 0 ? box.max.z : box.min.z};
    }
    return corners;
}

/// From the target to the plane across the view that the foremost corner touches.
double nearestDistance(std::span<const glm::dvec3> corners, glm::dvec3 target, glm::dvec3 backward) {
    double distance = 0.0;
    for (const glm::dvec3& corner : corners)
        distance = std::max(distance, glm::dot(corner - target, backward));
    return distance;
}

/// Where the points lie in the picture: -1 to 1 is what the camera sees.
struct PictureRange {
    glm::dvec2 min{std::numeric_limits<double>::infinity()};
    glm::dvec2 max{-std::numeric_limits<double>::infinity()};
};
PictureRange project(std::span<const glm::dvec3> points, const ViewCamera& camera, glm::dvec2 tangents) {
    const CameraFrame frame = frameOf(camera);
    PictureRange range;
    for (const glm::dvec3& point : points) {
        const glm::dvec3 v = point - camera.position;
        const double depth = glm::dot(v, frame.forward);
        const glm::dvec2 p = glm::dvec2(glm::dot(v, frame.right), glm::dot(v, frame.up)) / (depth * tangents);
        range.min = glm::min(range.min, p);
        range.max = glm::max(range.max, p);
    }
    return range;
}

}  // namespace

ViewCamera cameraFraming(const gpu::WorldBox& box, double aspect, double fovYDegrees) {
    constexpr double kFilled = 0.92;  // of the picture, by the box
    ViewCamera camera{.fovYDegrees = fovYDegrees};
    if (box.empty()) return camera;
    const glm::dvec3 backward = glm::normalize(glm::dvec3(0.62, 0.48, 1.0));
    const double tanY = std::tan(glm::radians(0.5 * fovYDegrees));
    const glm::dvec2 tangents(tanY * aspect, tanY);
    const double radius = std::max(0.5 * glm::length(box.max - box.min), 1e-9);
    camera.target = 0.5 * (box.min + box.max);
    double distance = 1.05 * radius * (1.0 + 1.0 / std::min(tangents.x, tangents.y));  // surely outside
    camera.position = camera.target + distance * backward;

    // Perspective makes near corners larger, so the middle of the box is not the middle of the picture: shift
    // and zoom towards both until nothing changes any more.
    const std::array<glm::dvec3, 8> corners = cornersOf(box);
    const CameraFrame frame = frameOf(camera);
    for (int i = 0; i < 24; ++i) {
        const PictureRange range = project(corners, camera, tangents);
        const glm::dvec2 shift = 0.5 * (range.min + range.max) * tangents * distance;
        const glm::dvec2 half = 0.5 * (range.max - range.min);
        camera.target += shift.x * frame.right + shift.y * frame.up;
        distance = std::max(distance * std::max(half.x, half.y) / kFilled,
                            1.02 * nearestDistance(corners, camera.target, backward));
        camera.position = camera.target + distance * backward;
    }
    return camera;
}

}  // namespace pfvox::viewer
