// Projection: from the world to points of the window and back, for what is drawn upon the picture.
#pragma once

#include <optional>
#include <utility>

#include "camera.hpp"

namespace pfvox::viewer {

struct WorldRay {
    glm::dvec3 origin{0.0};
    glm::dvec3 direction{0.0, 0.0, -1.0};  ///< unit length
    bool operator==(const WorldRay&) const = default;
};

/// A camera and the window that its picture fills; points from the upper left, in the window's unit.
class Projection {
  public:
    Projection(const ViewCamera& camera, glm::dvec2 windowSize);

    /// Nothing when the point is behind the camera or next to it.
    std::optional<glm::dvec2> pointOf(const glm::dvec3& world) const;
    /// The part of a line in front of the camera; nothing when there is none.
    std::optional<std::pair<glm::dvec2, glm::dvec2>> lineOf(const glm::dvec3& from,
                                                            const glm::dvec3& to) const;
    WorldRay rayAt(const glm::dvec2& point) const;
    /// Of a point, along the view; negative behind the camera.
    double depthOf(const glm::dvec3& world) const;
    /// Metres that a unit of the window stands for at this depth.
    double metresPerUnit(double depth) const;
    const glm::dvec2& windowSize() const { return size_; }

  private:
    glm::dvec2 onScreen(const glm::dvec3& view) const;
    glm::dvec3 viewOf(const glm::dvec3& world) const;

    glm::dvec3 position_;
    CameraFrame frame_;
    glm::dvec2 size_;
    double tanY_;
};

}  // namespace pfvox::viewer
