#include "compose/gizmo.hpp"

#include <cmath>
#include <limits>
#include <numbers>

namespace pfvox::viewer {

namespace {

constexpr double kArrowUnits = 70.0;  // length of an arrow in the window
constexpr double kReachUnits = 8.0;   // how near the cursor must come
constexpr double kSquarePart = 0.35;  // of an arrow: edge of the ground's square
constexpr double kCirclePart = 0.8;   // of an arrow: radius of the circle
constexpr double kEdgeOn = 0.02;      // sine of the angle below which nothing is dragged
constexpr int kCirclePieces = 48;
constexpr double kFar = std::numeric_limits<double>::infinity();

glm::dvec3 axisOf(Handle handle) {
    return handle == Handle::X   ? glm::dvec3(1, 0, 0)
           : handle == Handle::Y ? glm::dvec3(0, 1, 0)
                                 : glm::dvec3(0, 0, 1);
}

double distanceToLine(const glm::dvec2& p, const glm::dvec2& a, const glm::dvec2& b) {
    const glm::dvec2 ab = b - a;
    const double length2 = glm::dot(ab, ab);
    const double t = length2 > 0.0 ? glm::clamp(glm::dot(p - a, ab) / length2, 0.0, 1.0) : 0.0;
    return glm::length(p - a - t * ab);
}

}  // namespace

Gizmo::Gizmo(const Projection& projection, const glm::dvec3& origin)
    : projection_(projection), origin_(origin) {
    const double depth = projection.depthOf(origin);
    if (projection.pointOf(origin)) size_ = kArrowUnits * projection.metresPerUnit(depth);
}

glm::dvec3 Gizmo::tipOf(Handle handle) const {
    if (handle == Handle::Ground) return origin_ + kSquarePart * size_ * glm::dvec3(1, 0, 1);
    return origin_ + size_ * axisOf(handle);
}

glm::dvec3 Gizmo::circleAt(double radians) const {
    return origin_ + kCirclePart * size_ * glm::dvec3(std::cos(radians), 0.0, -std::sin(radians));
}

double Gizmo::distanceTo(Handle handle, const glm::dvec2& cursor) const {
    if (handle == Handle::Ground) {
        const auto ground = onGround(cursor);
        if (!ground) return kFar;
        const glm::dvec3 part = (*ground - origin_) / (kSquarePart * size_);
        // The middle belongs to the arrows' common end: nobody could take hold of one there.
        const bool inside = part.x > 0.1 && part.z > 0.1 && part.x < 1.0 && part.z < 1.0;
        return inside ? 0.0 : kFar;
    }
    if (handle == Handle::Turn) {
        double nearest = kFar;
        for (int i = 0; i < kCirclePieces; ++i) {
            const double step = 2.0 * std::numbers::pi / kCirclePieces;
            const auto line = projection_.lineOf(circleAt(i * step), circleAt((i + 1) * step));
            if (line) nearest = std::min(nearest, distanceToLine(cursor, line->first, line->second));
        }
        return nearest;
    }
    // Not all the way in, where all arrows meet.
    const auto line = projection_.lineOf(glm::mix(origin_, tipOf(handle), 0.2), tipOf(handle));
    return line ? distanceToLine(cursor, line->first, line->second) : kFar;
}

std::optional<Handle> Gizmo::handleAt(const glm::dvec2& cursor) const {
    if (!isSeen()) return std::nullopt;
    std::optional<Handle> best;
    double nearest = kReachUnits;
    for (const Handle handle : kHandles) {
        const double distance = distanceTo(handle, cursor);
        if (distance < nearest) {
            nearest = distance;
            best = handle;
        }
    }
    return best;
}

std::optional<glm::dvec3> Gizmo::onGround(const glm::dvec2& point) const {
    const WorldRay ray = projection_.rayAt(point);
    if (std::abs(ray.direction.y) < kEdgeOn) return std::nullopt;
    const double t = (origin_.y - ray.origin.y) / ray.direction.y;
    if (t <= 0.0) return std::nullopt;
    return ray.origin + t * ray.direction;
}

/// Where the axis through the origin comes nearest to the ray, metres from the origin.
std::optional<double> Gizmo::alongAxis(const glm::dvec3& axis, const glm::dvec2& point) const {
    const WorldRay ray = projection_.rayAt(point);
    const double b = glm::dot(axis, ray.direction);
    const double sine2 = 1.0 - b * b;
    if (sine2 < kEdgeOn * kEdgeOn) return std::nullopt;
    const glm::dvec3 w = origin_ - ray.origin;
    return (b * glm::dot(ray.direction, w) - glm::dot(axis, w)) / sine2;
}

glm::dvec3 Gizmo::moved(Handle handle, const glm::dvec2& from, const glm::dvec2& to) const {
    if (handle == Handle::Turn || !isSeen()) return glm::dvec3(0.0);
    if (handle == Handle::Ground) {
        const auto a = onGround(from);
        const auto b = onGround(to);
        return a && b ? *b - *a : glm::dvec3(0.0);
    }
    const glm::dvec3 axis = axisOf(handle);
    const auto a = alongAxis(axis, from);
    const auto b = alongAxis(axis, to);
    return a && b ? (*b - *a) * axis : glm::dvec3(0.0);
}

double Gizmo::turned(const glm::dvec2& from, const glm::dvec2& to) const {
    const auto a = onGround(from);
    const auto b = onGround(to);
    if (!a || !b) return 0.0;
    const auto angle = [&](const glm::dvec3& p) { return std::atan2(-(p.z - origin_.z), p.x - origin_.x); };
    return std::remainder(angle(*b) - angle(*a), 2.0 * std::numbers::pi);
}

}  // namespace pfvox::viewer
