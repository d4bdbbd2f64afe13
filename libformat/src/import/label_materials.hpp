// Materials for sources that tell their voxels apart by number only (SVX material ids, integer VDB grids):
// such a number has no color, so each gets one that differs from its neighbors' and is always the same.
#pragma once

#include <cstdint>
#include <pfvox/asset.hpp>
#include <string>

namespace pfvox::import {

/// A diffuse material with a color that follows from `label` alone.
Material labelMaterial(std::int64_t label, std::string name);

}  // namespace pfvox::import
