// Merge: flattens instances into one model in world voxel space.
#pragma once

#include <pfvox/error.hpp>
#include <pfvox/limits.hpp>
#include <pfvox/voxel_model.hpp>
#include <span>

#include "import/vox/instances.hpp"

namespace pfvox::import::vox {

struct MergedModel {
    VoxelModel model;
    std::uint64_t replacedVoxels = 0;  ///< voxels that one of a later instance took the place of
};

/// Of voxels in one place that of the last instance wins. `models` are indexed by GridInstance::model and
/// made by scatterVoxels. Errors: LimitExceeded (maxMemoryBytes, maxRegions, maxModelDepth).
Result<MergedModel> mergeInstances(const std::vector<VoxelModel>& models,
                                   std::span<const GridInstance> instances, const Limits& limits);

}  // namespace pfvox::import::vox
