// The faces of a model's voxels that something can be seen on.
#pragma once

#include <cstdint>
#include <functional>
#include <pfvox/octree.hpp>
#include <vector>

namespace pfvox::bake {

/// A leaf of a region's octree: a cube of one material.
struct Leaf {
    glm::ivec3 corner{0};  ///< model voxels
    int edge = 1;          ///< voxels
    MaterialIndex material = 0;
};

/// Calls `visit` for every leaf, in the order of nodes and slots.
void forEachLeaf(const OctreeRegion& region, const std::function<void(const Leaf&)>& visit);

/// A face of a voxel: 0..5 = -x +x -y +y -z +z.
struct VoxelFace {
    glm::ivec3 voxel{0};
    int face = 0;
    MaterialIndex material = 0;

    int axis() const { return face / 2; }
    bool isUpper() const { return face % 2 != 0; }
};

/// By material of the asset, one entry each.
struct FaceFilter {
    std::vector<bool> wanted;  ///< faces of these voxels
    std::vector<bool> hides;   ///< that touch none of these
};

/// Calls `visit` for each wanted face whose neighbor is empty or does not hide it; always in the same order.
/// Takes 2 MB and time by the surface of leaves, not by their volume.
void forEachExposedFace(const OctreeModel& model, const FaceFilter& filter,
                        const std::function<void(const VoxelFace&)>& visit);

}  // namespace pfvox::bake
