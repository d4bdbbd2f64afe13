// The rotation byte of VOX files.
#pragma once

#include <cstdint>
#include <optional>

#include "import/grid_transform.hpp"

namespace pfvox::import::vox {

/// Decodes the byte that VOX files keep as `_r`: bits 0-1 the column of row 0, bits 2-3 that of row 1, bits
/// 4, 5 and 6 the signs of the rows, 1 meaning negative. Nothing unless the columns differ and are below 3
/// (48 of 128 values).
std::optional<Rotation> decodeRotation(std::int32_t byte);

}  // namespace pfvox::import::vox
