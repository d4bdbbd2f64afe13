#include "compose/projection.hpp"

#include <cmath>

namespace pfvox::viewer {

namespace {
constexpr double kNearestMetres = 1e-4;
}

Projection::Projection(const ViewCamera& camera, glm::dvec2 windowSize)
    : position_(camera.position),
      frame_(frameOf(camera)),
      size_(glm::max(windowSize, glm::dvec2(1.0))),
      tanY_(std::tan(glm::radians(0.5 * camera.fovYDegrees))) {}

glm::dvec3 Projection::viewOf(const glm::dvec3& world) const {
    const glm::dvec3 v = world - position_;
    return {glm::dot(v, frame_.right), glm::dot(v, frame_.up), glm::dot(v, frame_.forward)};
}

glm::dvec2 Projection::onScreen(const glm::dvec3& view) const {
    const double unitsPerTangent = 0.5 * size_.y / tanY_;
    return 0.5 * size_ + unitsPerTangent / view.z * glm::dvec2(view.x, -view.y);
}

std::optional<glm::dvec2> Projection::pointOf(const glm::dvec3& world) const {
    const glm::dvec3 view = viewOf(world);
    if (view.z < kNearestMetres) return std::nullopt;
    return onScreen(view);
}

std::optional<std::pair<glm::dvec2, glm::dvec2>> Projection::lineOf(const glm::dvec3& from,
                                                                    const glm::dvec3& to) const {
    glm::dvec3 a = viewOf(from);
    glm::dvec3 b = viewOf(to);
    if (a.z < kNearestMetres && b.z < kNearestMetres) return std::nullopt;
    const auto clipped = [&](const glm::dvec3& outside, const glm::dvec3& inside) {
        return glm::mix(inside, outside, (inside.z - kNearestMetres) / (inside.z - outside.z));
    };
    if (a.z < kNearestMetres) a = clipped(a, b);
    if (b.z < kNearestMetres) b = clipped(b, a);
    return std::pair(onScreen(a), onScreen(b));
}

WorldRay Projection::rayAt(const glm::dvec2& point) const {
    const glm::dvec2 tangents = (point - 0.5 * size_) * (2.0 * tanY_ / size_.y);
    return {.origin = position_,
            .direction = glm::normalize(frame_.forward + tangents.x * frame_.right - tangents.y * frame_.up)};
}

double Projection::depthOf(const glm::dvec3& world) const {
    return viewOf(world).z;
}

double Projection::metresPerUnit(double depth) const {
    return 2.0 * tanY_ * depth / size_.y;
}

}  // namespace pfvox::viewer
