// Asset check: what every importer's result goes through, whatever the format.
#pragma once

#include <pfvox/error.hpp>
#include <pfvox/voxel_model.hpp>
#include <string>

namespace pfvox::import {

/// Names and notes become UTF-8: bytes that are none are read as Windows-1252. Models without voxels are
/// counted. Diagnostics: name-encoding (warning), empty-models (a note; a warning where no model has a
/// voxel).
void checkAsset(VoxelAsset& asset, Diagnostics& diagnostics);

}  // namespace pfvox::import
