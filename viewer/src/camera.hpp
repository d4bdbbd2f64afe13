// The viewer's camera: where it stands, what it looks at, and how it frames a scene.
#pragma once

#include <glm/glm.hpp>
#include <pfvox/gpu_scene.hpp>

namespace pfvox::viewer {

/// A pinhole camera in metres and degrees. Up is +Y; straight up or down looks are allowed.
struct ViewCamera {
    glm::dvec3 position{0.0, 0.0, 5.0};
    glm::dvec3 target{0.0};
    double fovYDegrees = 40.0;
    bool operator==(const ViewCamera&) const = default;
};

/// A camera that a scene or an asset holds.
ViewCamera viewCameraOf(const Camera& camera);

/// Right-handed and orthonormal.
struct CameraFrame {
    glm::dvec3 forward{0.0, 0.0, -1.0};
    glm::dvec3 right{1.0, 0.0, 0.0};
    glm::dvec3 up{0.0, 1.0, 0.0};
};
CameraFrame frameOf(const ViewCamera& camera);

/// A three-quarter view from slightly above that holds the whole box; the front (+Z) is towards the camera.
/// `aspect` = width / height. An empty box gives the default camera.
ViewCamera cameraFraming(const gpu::WorldBox& box, double aspect, double fovYDegrees);

}  // namespace pfvox::viewer
