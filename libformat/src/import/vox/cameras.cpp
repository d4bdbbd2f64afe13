#include "import/vox/cameras.hpp"

#include <fmt/format.h>
#include <cmath>
#include <numbers>

namespace pfvox::import::vox {

namespace {

glm::dvec3 yUpFromVox(glm::dvec3 p) {
    return {p.x, p.z, -p.y};
}

glm::dvec3 viewDirection(double pitchDegrees, double yawDegrees) {
    constexpr double kRadians = std::numbers::pi / 180.0;
    const double pitch = pitchDegrees * kRadians;
    const double yaw = yawDegrees * kRadians;
    return {-std::sin(yaw) * std::cos(pitch), std::cos(yaw) * std::cos(pitch), -std::sin(pitch)};
}

}  // namespace

Result<std::optional<Camera>> readCamera(Chunk& chunk, double voxelSizeMetres) {
    PFVOX_TRY(const std::int32_t, id, chunk.readInt("the camera id"));
    PFVOX_TRY(const Dict, attributes, chunk.readDict("the camera's attributes"));
    const auto vector = [&](std::string_view key) {
        const auto text = attributes.find(key);
        const auto v = text ? parseFloat3(*text) : std::nullopt;
        return v ? glm::dvec3{(*v)[0], (*v)[1], (*v)[2]} : glm::dvec3{0.0};
    };
    const auto number = [&](std::string_view key, double fallback) {
        const auto text = attributes.find(key);
        return text ? static_cast<double>(parseFloat(*text).value_or(static_cast<float>(fallback)))
                    : fallback;
    };
    const glm::dvec3 focus = vector("_focus");
    const glm::dvec3 angles = vector("_angle");
    const double radius = std::max(number("_radius", 0.0), 0.0);
    if (focus == glm::dvec3{0.0} && angles == glm::dvec3{0.0} && radius <= 1.0)
        return std::optional<Camera>{};

    const glm::dvec3 direction = viewDirection(angles.x, angles.y);
    const glm::dvec3 eye = focus - radius * direction;
    // Far from the origin a small radius is lost in float32, as which a file keeps both ends.
    const double leastRadius = 1e-6 * glm::length(focus);
    const bool seesFocus = radius > leastRadius;
    Camera camera;
    camera.name = fmt::format("camera {}", id);
    camera.position = voxelSizeMetres * yUpFromVox(eye);
    camera.target =
        voxelSizeMetres * yUpFromVox(seesFocus ? focus : eye + std::max(1.0, leastRadius) * direction);
    camera.fovYDegrees = std::clamp(number("_fov", 45.0), 1.0, 179.0);
    return std::optional{camera};
}

}  // namespace pfvox::import::vox
