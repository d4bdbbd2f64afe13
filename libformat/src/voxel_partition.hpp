// VoxelPartition: a list of voxels, in whatever order it came, sorted by region (and by nothing else).
//
// Regions are independent of each other from here on: filling their bricks and building their octrees are
// parallel over the parts. The list is read once: slices of it that fit in the cache are sorted each for
// itself, and a region's voxels are the pieces that it has in the slices.
#pragma once

#include <pfvox/voxel_model.hpp>
#include <span>
#include <vector>

#include "large_array.hpp"

namespace pfvox {

class VoxelPartition {
  public:
    /// The voxels of one region from one slice of the list.
    struct Piece {
        glm::ivec3 regionCoord{0};
        std::span<const RegionVoxel> voxels;
    };

    /// `voxels` are relative to `origin`. Runs in the calling TBB arena; the result does not depend on it.
    VoxelPartition(std::span<const PackedVoxel> voxels, glm::ivec3 origin);

    /// For each region that has voxels, its pieces in the order of the list.
    const std::vector<std::span<const Piece>>& parts() const { return parts_; }

  private:
    LargeArray<RegionVoxel> voxels_;
    std::vector<Piece> pieces_;
    std::vector<std::span<const Piece>> parts_;
};

}  // namespace pfvox
