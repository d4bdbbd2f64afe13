// VoxelPartition: a list of voxels, in whatever order it came, sorted by region (and by nothing else).
//
// Regions are independent of each other from here on: filling their bricks and building their octrees are
// parallel over the parts.
#pragma once

#include <memory>
#include <optional>
#include <pfvox/voxel_model.hpp>
#include <span>
#include <vector>

namespace pfvox {

class VoxelPartition {
  public:
    /// The voxels of one region, in the order of the list.
    struct Part {
        glm::ivec3 regionCoord{0};
        std::span<const RegionVoxel> voxels;
    };

    /// `voxels` are relative to `origin`. Nothing where partitioning does not pay: the list is short, or
    /// spread so widely that counting its regions would take more than going through it. Runs in the calling
    /// TBB arena.
    static std::optional<VoxelPartition> make(std::span<const PackedVoxel> voxels, glm::ivec3 origin);

    /// Parts that are not empty; the order depends on nothing but the list.
    const std::vector<Part>& parts() const { return parts_; }

  private:
    std::unique_ptr<RegionVoxel[]> voxels_;
    std::vector<Part> parts_;
};

}  // namespace pfvox
