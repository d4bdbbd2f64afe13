// Export: from octrees back to a source format, so that anybody can check a round trip with other tools.
//
//     .pf_vox -> OctreeAsset -> [exportVox] -> .vox
#pragma once

#include <cstddef>
#include <pfvox/error.hpp>
#include <pfvox/octree.hpp>
#include <vector>

namespace pfvox {

/// The bytes of a MagicaVoxel file (version 150, with scene graph, layers, materials and names). Models larger than 256
/// voxels become several, placed side by side. World positions are those of the asset, in voxels of its voxel size.
///
/// Errors: UnsupportedFeature when an instance is not turned by quarter turns and moved by whole voxels;
/// LimitExceeded for more than 255 materials; NothingToConvert without any voxel.
/// Diagnostics: export-vox-precision, where a material parameter has no counterpart.
Result<std::vector<std::byte>> exportVox(const OctreeAsset& asset, Diagnostics& diagnostics);

}  // namespace pfvox
