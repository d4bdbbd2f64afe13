// Pick: what lies under the cursor.
#pragma once

#include <optional>
#include <pfvox/ray_query.hpp>
#include <pfvox/scene.hpp>
#include <string>

#include "camera.hpp"

namespace pfvox::viewer {

/// The ray through a point of the picture, given as parts of its edges from the upper left.
gpu::GpuRay rayThrough(const ViewCamera& camera, glm::dvec2 parts, double aspect);

struct Pick {
    std::size_t modelIndex = 0;  ///< in Scene::models
    std::string model;           ///< name, else path, of the scene's model
    std::string instance;        ///< its number within the file, and its name if it has one
    std::string material;        ///< its number within the file, its name if it has one, and its type
    glm::u8vec4 baseColor{0};
    glm::ivec3 voxel{0};
    double distanceMetres = 0.0;
    glm::dvec3 point{0.0};  ///< metres
};

/// What a hit means in the scene's own words; nothing for a miss.
std::optional<Pick> describePick(const LoadedScene& scene, const gpu::GpuRay& ray, const gpu::GpuHit& hit);

/// Index of the grid's probe that stands nearest to a point, as the grid has it.
std::uint32_t nearestProbe(const ProbeGrid& grid, const glm::dvec3& point);

}  // namespace pfvox::viewer
