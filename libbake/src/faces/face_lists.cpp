#include "faces/face_lists.hpp"

#include <tbb/parallel_for.h>

#include <bit>

namespace pfvox::bake {

namespace {

shared::FaceFrame frameOf(const gpu::PlacedFaces& placed) {
    const Affine& m = placed.frameFromModel;
    const glm::dvec3 corner = m * glm::dvec4(glm::dvec3(placed.model->originVoxels), 1.0);
    return {.edgeX = glm::vec4(glm::vec3(m[0]), 0.0f),
            .edgeY = glm::vec4(glm::vec3(m[1]), 0.0f),
            .edgeZ = glm::vec4(glm::vec3(m[2]), 0.0f),
            .corner = glm::vec4(glm::vec3(corner), 0.0f)};
}

/// The faces of one brick, from its first one on.
void listBrick(const gpu::PlacedFaces& placed, const FaceRegion& region, const FaceBrick& brick,
               shared::FaceRecord* out) {
    const glm::uvec3 corner(region.originVoxels - placed.model->originVoxels + brick.corner());
    std::uint32_t mask = brick.firstMask;
    for (std::uint32_t face = 0; face < 6; ++face) {
        if ((brick.directions >> face & 1u) == 0) continue;
        for (std::uint64_t rest = placed.index->masks[mask++]; rest != 0; rest &= rest - 1) {
            const auto k = static_cast<std::uint32_t>(std::countr_zero(rest));
            *out++ = {.x = corner.x + (k & 3u),
                      .y = corner.y + (k >> 2 & 3u),
                      .z = corner.z + (k >> 4),
                      .instanceAndFace = placed.instance << 3 | face};
        }
    }
}

}  // namespace

FaceLists listFaces(const gpu::Scene& scene) {
    FaceLists lists;
    lists.records.resize(scene.faceCount());
    for (const gpu::PlacedFaces& placed : scene.faces()) {
        if (lists.frames.size() <= placed.instance) lists.frames.resize(placed.instance + std::size_t{1});
        lists.frames[placed.instance] = frameOf(placed);
        shared::FaceRecord* const first = lists.records.data() + placed.firstFace;
        for (const FaceRegion& region : placed.index->regions) {
            tbb::parallel_for(region.firstBrick, region.endBrick, [&](std::uint32_t i) {
                const FaceBrick& brick = placed.index->bricks[i];
                listBrick(placed, region, brick, first + brick.firstFace);
            });
        }
        std::uint32_t next = placed.firstFace;
        for (const std::uint64_t mask : placed.index->masks) {
            lists.clusters.push_back(next);
            next += static_cast<std::uint32_t>(std::popcount(mask));
        }
    }
    lists.clusters.push_back(scene.faceCount());
    return lists;
}

}  // namespace pfvox::bake
