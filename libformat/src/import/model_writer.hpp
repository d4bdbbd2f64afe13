// ModelWriter: writes voxels and solid cubes anywhere in a model and counts what they replace.
#pragma once

#include <pfvox/voxel_model.hpp>

namespace pfvox::import {

/// Remembers the last brick, and keeps account of the memory that writing takes.
class ModelWriter {
  public:
    explicit ModelWriter(VoxelModel& model) : model_(model) {}

    /// Returns whether there was a voxel before.
    bool set(glm::ivec3 voxel, MaterialIndex material);

    /// Fills a cube and returns how many voxels there were before. It stays whole where it covers whole cells
    /// of 8^3.
    std::uint64_t fillCube(glm::ivec3 corner, int edge, MaterialIndex material);

    std::uint64_t memoryBytes() const;

  private:
    std::uint64_t fillCell(glm::ivec3 cell, MaterialIndex material);
    std::uint64_t fillRegion(VoxelRegion& region, MaterialIndex material);
    std::uint64_t setBox(glm::ivec3 low, glm::ivec3 high, MaterialIndex material);
    void findBrick(glm::ivec3 cell);

    VoxelModel& model_;
    glm::ivec3 cell_{0};
    Brick* brick_ = nullptr;
    std::uint64_t bricks_ = 0;
};

}  // namespace pfvox::import
