// SLAB6: an older format whose files are named .vox too. pfvox does not read it, but says what it is.
#pragma once

#include <cstddef>
#include <span>

namespace pfvox::import::vox {

/// Whether these bytes are a SLAB6 model: i32 size of each axis, one byte a voxel, 256 colors of 3 bytes, no
/// magic. The sizes must account for every byte.
bool isSlab6(std::span<const std::byte> bytes);

}  // namespace pfvox::import::vox
