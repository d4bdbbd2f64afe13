// Where the model of a VDB grid stands in our world.
#pragma once

#include <openvdb/math/Transform.h>

#include <pfvox/import.hpp>

namespace pfvox::import::vdb {

/// In units of the file. Voxel (i, j, k) of the model is index (i, j, k) of the grid, or with z up what
/// fillModel() makes of it. Precondition: the transform is linear.
Affine worldFromModel(const openvdb::math::Transform& transform, UpAxis up);

}  // namespace pfvox::import::vdb
