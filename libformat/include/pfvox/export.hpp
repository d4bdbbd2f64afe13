// Export: from octrees back to a source format, so that anybody can check a round trip with other tools.
//
//     .pf_vox -> OctreeAsset -> [exportVox, exportVdb] -> .vox, .vdb
#pragma once

#include <cstddef>
#include <pfvox/error.hpp>
#include <pfvox/limits.hpp>
#include <pfvox/octree.hpp>
#include <vector>

namespace pfvox {

/// The bytes of a MagicaVoxel file (version 150, with scene graph, layers, materials and names). Models
/// larger than 256 voxels become several, placed side by side. World positions are those of the asset, in
/// voxels of its voxel size.
///
/// Errors: UnsupportedFeature when an instance is not turned by quarter turns and moved by whole voxels;
/// LimitExceeded for more than 255 materials; NothingToConvert without any voxel.
/// Diagnostics: export-vox-precision, where a material parameter has no counterpart.
Result<std::vector<std::byte>> exportVox(const OctreeAsset& asset, Diagnostics& diagnostics);

/// The bytes of an OpenVDB file of version 224, in metres, y up (docs/decisions/008-vdb-export.md). Every
/// instance is three grids: `density` (float, fog volume, 1 inside), `Cd` (vec3s, linear colors) and
/// `material` (int32, index of the material + 1); instances of one model share their trees. Octree leaves of
/// 8^3 and more stay tiles. Materials, names and layers are string metadata of the grids, so that an import
/// gives the same asset again. Equal assets give equal bytes.
///
/// Errors: UnsupportedFeature for transforms without an inverse; LimitExceeded (maxMemoryBytes; coordinates
/// beyond 2^30); NothingToConvert without any voxel. Diagnostics: export-vdb-unplaced, export-vdb-empty,
/// export-vdb-cameras.
Result<std::vector<std::byte>> exportVdb(const OctreeAsset& asset, const Limits& limits,
                                         Diagnostics& diagnostics);

}  // namespace pfvox
