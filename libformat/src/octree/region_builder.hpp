// RegionBuilder: one 256^3 region of a voxel model becomes its octree, exactly minimised.
#pragma once

#include <pfvox/error.hpp>
#include <pfvox/octree.hpp>
#include <pfvox/voxel_model.hpp>

#include "octree/node_writer.hpp"

namespace pfvox::octree {

/// Whether the region holds no voxel at all.
bool isEmpty(const VoxelRegion& region);

/// Reusable by one thread for many regions; keeps its buffers.
class RegionBuilder {
  public:
    /// How far the tree may shrink: a region below a top tree keeps its 8 levels, the only region of a model
    /// is cut to the smallest aligned cube around its voxels.
    enum class Extent { Full, Shrink };

    /// The result lies in the pool. Precondition: !isEmpty(source). Errors: BadReference, LimitExceeded.
    Result<OctreeRegion> build(const VoxelRegion& source, Extent extent, std::size_t materialCount,
                               const std::shared_ptr<MemoryPool>& pool);

  private:
    Slot buildRoot(const VoxelRegion& source);
    /// 8^levels blocks of 4^3 cells each.
    Slot buildBlocks(const VoxelRegion& source, std::uint32_t firstBlock, std::uint32_t levels);
    Slot buildBlock(const VoxelRegion& source, std::uint32_t block);
    Slot buildCell(const VoxelRegion& source, std::uint32_t index);
    Slot buildBrick(const Brick& brick);
    void measureTile(std::uint32_t cell);
    void measureBrick(std::uint32_t cell, const Brick& brick);

    NodeWriter writer_;
    std::uint64_t voxelCount_ = 0;
    VoxelBox bounds_;  ///< of the voxels so far, in the region
};

}  // namespace pfvox::octree
