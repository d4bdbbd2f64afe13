// Model set: builds the VoxelModels of those models of a VOX file that are wanted.
#pragma once

#include <pfvox/error.hpp>
#include <pfvox/limits.hpp>
#include <pfvox/voxel_model.hpp>
#include <vector>

#include "import/vox/voxel_scatter.hpp"

namespace pfvox::import::vox {

struct ModelSet {
    std::vector<VoxelModel> models;                ///< by model id; those that are not wanted are empty
    std::array<bool, kPaletteSize> usedIndices{};  ///< palette indices of the voxels kept
};

/// Builds every model whose `wanted` is true, in parallel; the result does not depend on the number of
/// threads. Errors: LimitExceeded (maxMemoryBytes). Diagnostics: vox-voxels-outside,
/// vox-voxels-without-color, vox-duplicate-voxels.
Result<ModelSet> buildModels(const std::vector<ModelRecord>& records, const std::vector<bool>& wanted,
                             const Limits& limits, Diagnostics& diagnostics);

}  // namespace pfvox::import::vox
