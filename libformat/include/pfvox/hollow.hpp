// Hollow: gives voxels that nobody can see the material that makes the file smallest.
//
//     VoxelAsset -> [hollowSolids] -> VoxelAsset -> buildOctrees
//
// Optional (`--hollow`) and lossy: what was inside a solid is not kept. A voxel is hidden when it is opaque
// and so are its six face neighbors, in the same model and across the borders of bricks and regions. Every
// other voxel keeps its material, and no voxel appears, vanishes or changes between opaque and transparent:
// solids stay solid. Why hidden voxels change their material and do not vanish: docs/decisions/005-hollow.md.
#pragma once

#include <cstdint>
#include <pfvox/voxel_model.hpp>

namespace pfvox {
/// What hollowing changed.
struct HollowReport {
    std::uint64_t hiddenVoxels = 0;   ///< voxels that could take any material
    std::uint64_t changedVoxels = 0;  ///< of these, voxels that took another one
};

/// Hollows every model in place and sets AssetInfo::hollowed. The octree of the result has the fewest leaves
/// that any choice of hidden materials gives: a cube that is full and whose visible voxels have one material
/// takes this material throughout. Where there are more, hidden voxels take the most frequent visible
/// material of their cube of 64^3 (of equally frequent ones the first), or the most frequent hidden one where
/// nothing opaque is visible. Doing it twice changes nothing more. Regions are treated in parallel in the
/// calling TBB arena; the result does not depend on the number of threads.
HollowReport hollowSolids(VoxelAsset& asset);

}  // namespace pfvox
