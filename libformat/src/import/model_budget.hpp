// ModelBudget: keeps the voxel model that an importer fills within Limits. A few bytes of an octree or of a
// VDB can announce a cube of astronomic size; what counts is the memory that the model takes, so it is
// measured while it grows.
#pragma once

#include <pfvox/error.hpp>
#include <pfvox/limits.hpp>
#include <pfvox/voxel_model.hpp>

namespace pfvox::import {

/// Ask before large tiles and now and then while single voxels are written; the cost of a question grows with
/// the number of regions, not of voxels.
class ModelBudget {
  public:
    explicit ModelBudget(const Limits& limits) : limits_(limits) {}

    /// LimitExceeded when the model has outgrown maxRegions or, with the models finished before,
    /// maxMemoryBytes.
    Result<void> check(const VoxelModel& model) const;

    /// check(), but only now and then: for importers that write many small pieces and ask after each.
    Result<void> step(const VoxelModel& model);

    /// LimitExceeded when a solid cube of edge 2^edgeLog2 would add more regions than the model may still
    /// have.
    Result<void> checkTile(const VoxelModel& model, int edgeLog2) const;

    /// Counts a finished model against the memory of the asset.
    void close(const VoxelModel& model);

  private:
    Limits limits_;
    std::uint64_t closedBytes_ = 0;
    std::uint64_t steps_ = 0;
    std::size_t regionsAtNextCheck_ = 0;
};

}  // namespace pfvox::import
