// Cameras: chunk rCAM, the views that a user stored.
#pragma once

#include <optional>
#include <pfvox/asset.hpp>
#include <pfvox/error.hpp>

#include "import/vox/chunks.hpp"

namespace pfvox::import::vox {

/// Reads chunk rCAM, or nothing for a slot that was never set (MagicaVoxel writes ten). `_focus` is the point
/// looked at,
/// `_angle` pitch, yaw and roll in degrees, `_radius` the distance; pfvox::Camera has no roll. The direction
/// follows from turning a view along +y (VOX axes) about x by the pitch, downwards, then about z by the yaw;
/// the format text is silent on it.
Result<std::optional<Camera>> readCamera(Chunk& chunk, double voxelSizeMetres);

}  // namespace pfvox::import::vox
