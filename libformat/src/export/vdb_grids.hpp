// From an octree to VDB trees. Leaves of 8, 128 and 4096 voxels become tiles of VDB, those between become
// several; no leaf of 8^3 or more is ever expanded into voxels.
#pragma once

#include <openvdb/Grid.h>
#include <openvdb/openvdb.h>

#include <pfvox/error.hpp>
#include <pfvox/limits.hpp>
#include <pfvox/octree.hpp>
#include <set>

namespace pfvox::vdb_export {

/// The three grids of a model; none where it has no voxel. All have the same active voxels and tiles.
struct ModelGrids {
    openvdb::FloatGrid::Ptr density;    ///< 1 inside, a fog volume
    openvdb::Vec3SGrid::Ptr color;      ///< linear
    openvdb::Int32Grid::Ptr material;   ///< index of the material + 1
    std::set<MaterialIndex> materials;  ///< those that occur
};

/// `grids` get no transform. `memoryBytes` is that of the models before and grows by this one's.
/// Errors: LimitExceeded (maxMemoryBytes; coordinates beyond 2^30).
Result<ModelGrids> makeGrids(const OctreeModel& model, const std::vector<Material>& materials,
                             const Limits& limits, std::uint64_t& memoryBytes);

/// The linear value of an sRGB byte.
float linearOf(std::uint8_t srgb);

}  // namespace pfvox::vdb_export
