// Lists of faces, as the programs of a bake take them.
#pragma once

#include <pfvox/gpu_scene.hpp>
#include <vector>

#include "shared/faces.glsl.h"

namespace pfvox::bake {

struct FaceLists {
    std::vector<shared::FaceFrame> frames;    ///< by record of the instance
    std::vector<shared::FaceRecord> records;  ///< in the order of gpu::Scene::faces()
    /// First face of each cluster, and the end: the faces of one direction of a brick, neighbors on a surface
    /// most often.
    std::vector<std::uint32_t> clusters;
};

FaceLists listFaces(const gpu::Scene& scene);

}  // namespace pfvox::bake
