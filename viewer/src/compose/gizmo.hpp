// Gizmo: the handles at a model by which the mouse moves and turns it. Knows neither window nor scene.
#pragma once

#include <array>

#include "compose/projection.hpp"

namespace pfvox::viewer {

enum class Handle : std::uint8_t {
    X,  ///< move along an axis of the world
    Y,
    Z,
    Ground,  ///< move level
    Turn,    ///< about the vertical
};
inline constexpr std::array kHandles{Handle::Ground, Handle::X, Handle::Y, Handle::Z, Handle::Turn};

class Gizmo {
  public:
    /// At a point of the world, of about the same size on every screen.
    Gizmo(const Projection& projection, const glm::dvec3& origin);

    /// False when the point is behind the camera: no handles then.
    bool isSeen() const { return size_ > 0.0; }
    const glm::dvec3& origin() const { return origin_; }
    /// The end of an axis' arrow (X, Y, Z), or a corner of the ground's square (Ground: the far one).
    glm::dvec3 tipOf(Handle handle) const;
    /// A point of the circle of Turn.
    glm::dvec3 circleAt(double radians) const;

    /// The handle under the cursor.
    std::optional<Handle> handleAt(const glm::dvec2& cursor) const;
    /// How far a drag from one point of the window to another moves, in metres; 0 for Turn, and where the
    /// plane or axis is seen edge-on.
    glm::dvec3 moved(Handle handle, const glm::dvec2& from, const glm::dvec2& to) const;
    /// How far it turns, counter-clockwise about +Y, in radians.
    double turned(const glm::dvec2& from, const glm::dvec2& to) const;

  private:
    std::optional<glm::dvec3> onGround(const glm::dvec2& point) const;
    std::optional<double> alongAxis(const glm::dvec3& axis, const glm::dvec2& point) const;
    double distanceTo(Handle handle, const glm::dvec2& cursor) const;

    Projection projection_;
    glm::dvec3 origin_;
    double size_ = 0.0;  ///< metres
};

}  // namespace pfvox::viewer
