// FaceIndex: the faces of a model's voxels that light can reach, numbered. What is baked for faces
// (pfvox/face_light.hpp) is a list in this order; the model itself says whose face each entry is.
//
//     OctreeModel, materials -> [makeFaceIndex] -> bricks with masks -> face number -> value
//
// Model space: voxels. Faces of a voxel: 0..5 = -x +x -y +y -z +z.
#pragma once

#include <cstdint>
#include <pfvox/asset.hpp>
#include <pfvox/octree.hpp>
#include <span>
#include <vector>

namespace pfvox {

/// 4^3 voxels with exposed faces.
struct FaceBrick {
    /// Its place in the region's cube: bits of x, y and z in brick edges, two of each axis at a time, x
    /// lowest. Ascending within a region.
    std::uint32_t path = 0;
    std::uint32_t firstFace = 0;  ///< number of its first face in the model
    std::uint32_t firstMask = 0;  ///< in FaceIndex::masks; one mask a direction that it has, ascending
    std::uint8_t directions = 0;  ///< bit d: some voxel's face d is exposed

    /// Lower corner in the region, voxels.
    glm::ivec3 corner() const;
};

/// The bricks of one region.
struct FaceRegion {
    glm::ivec3 originVoxels{0};  ///< OctreeRegion::originVoxels
    std::uint32_t firstBrick = 0;
    std::uint32_t endBrick = 0;
    std::uint32_t firstFace = 0;
    std::uint32_t endFace = 0;
};

struct FaceIndex {
    std::vector<FaceRegion> regions;  ///< as the model's
    std::vector<FaceBrick> bricks;
    /// Bit k = x + 4y + 16z: the face of this voxel of the brick is exposed.
    std::vector<std::uint64_t> masks;
    std::uint32_t faceCount = 0;

    /// Faces of a region in the order of files: by direction, of a direction by number. Neighbors on a
    /// surface stand close together, which is what compresses. Entry i: number of the face, from the region's
    /// first.
    std::vector<std::uint32_t> fileOrder(std::size_t region) const;
};

/// A face is exposed where the voxel can show light (all materials but glass without a Lambert fraction) and
/// its neighbor in the model does not hide it: a voxel that stops light (not letsThrough) hides every face,
/// glass hides faces of glass. Regions are read in parallel in the calling TBB arena. Errors: LimitExceeded
/// (2^32 faces or more).
Result<FaceIndex> makeFaceIndex(const OctreeModel& model, std::span<const Material> materials);

}  // namespace pfvox
