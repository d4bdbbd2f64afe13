// Palette: the colors of a VOX file by voxel index.
#pragma once

#include <array>
#include <pfvox/error.hpp>
#include <pfvox/math.hpp>

#include "import/vox/chunks.hpp"

namespace pfvox::import::vox {

inline constexpr std::size_t kPaletteSize = 256;

/// Element v is the sRGB color of voxels with index v; element 0 means "no voxel" and is transparent.
using Palette = std::array<glm::u8vec4, kPaletteSize>;

/// The palette of files without an RGBA chunk: a 6x6x6 cube of colors from white down, without its black,
/// then ramps of red, green, blue and gray.
Palette defaultPalette();

/// Reads chunk RGBA, whose entry i is the color of voxel index i + 1. The last entry is unused and may be
/// missing (1020 bytes).
Result<Palette> readPalette(Chunk& chunk);

/// Chunk IMAP: the order in which MagicaVoxel shows the palette. It changes no color, so it is checked and
/// dropped. Diagnostics: vox-imap-invalid.
void checkIndexMap(Chunk& chunk, Diagnostics& diagnostics);

}  // namespace pfvox::import::vox
