// Voxel scatter: from the list of voxels of a VOX model to a VoxelModel.
#pragma once

#include <array>
#include <pfvox/voxel_model.hpp>

#include "import/vox/rotation.hpp"
#include "import/vox/vox_file.hpp"

namespace pfvox::import::vox {

/// What was found on the way.
struct ScatterReport {
    std::uint64_t outside = 0;     ///< voxels beyond SIZE, dropped
    std::uint64_t colorless = 0;   ///< voxels with palette index 0, dropped
    std::uint64_t duplicates = 0;  ///< voxels that a later one of the same place replaced
    std::array<bool, kPaletteSize> usedIndices{};
};

/// The material of voxels with palette index v (1 to 255).
constexpr MaterialIndex materialOfPaletteIndex(std::uint32_t v) {
    return static_cast<MaterialIndex>(v - 1);
}

/// Point transform from VOX model axes (z up) to those of the VoxelModel: (x, y, z) -> (x, z, size.y - y), so
/// that its voxels lie in [0, size) too.
GridTransform modelFromVox(glm::ivec3 size);

/// Point transform from VOX world axes to those of pfvox: (x, y, z) -> (x, z, -y).
GridTransform worldFromVoxWorld();

/// Inserts all voxels of `record` into the empty `model`.
ScatterReport scatterVoxels(const ModelRecord& record, VoxelModel& model);

}  // namespace pfvox::import::vox
