// Merge: flattens instances into one model.
#pragma once

#include <pfvox/error.hpp>
#include <pfvox/limits.hpp>
#include <pfvox/voxel_model.hpp>
#include <span>
#include <vector>

#include "import/grid_transform.hpp"

namespace pfvox::import {

/// A model and where its voxels go, in whole voxels.
struct PlacedModel {
    std::uint32_t model = 0;  ///< index
    GridTransform mergedFromModel;
};

struct MergedModel {
    VoxelModel model;
    std::uint64_t replacedVoxels = 0;  ///< voxels that one of a later instance took the place of
};

/// Of voxels in one place that of the last instance wins. Solid cubes stay whole where they come to lie on
/// the grid of 8^3 cells. Errors: LimitExceeded (maxMemoryBytes, maxRegions, maxModelDepth).
Result<MergedModel> mergeModels(const std::vector<VoxelModel>& models, std::span<const PlacedModel> placed,
                                const Limits& limits);

/// Flattens a whole asset into one model on the grid of its first instance. Hidden instances and those on
/// hidden layers are left out, and so are models that no instance shows. An asset with one instance of one
/// model stays as it is. Errors: UnsupportedFeature when an instance is not turned by quarter turns and moved
/// by whole voxels against the first; NothingToConvert when all are hidden; those of mergeModels.
/// Diagnostics: merge-overlap.
Result<void> mergeAsset(VoxelAsset& asset, const Limits& limits, Diagnostics& diagnostics);

}  // namespace pfvox::import
