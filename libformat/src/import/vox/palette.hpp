// Palette: the colours of a VOX file by voxel index.
#pragma once

#include <array>
#include <pfvox/error.hpp>
#include <pfvox/math.hpp>

#include "import/vox/chunks.hpp"

namespace pfvox::import::vox {

inline constexpr std::size_t kPaletteSize = 256;

/// Element v is the sRGB colour of voxels with index v; element 0 means "no voxel" and is transparent.
using Palette = std::array<glm::u8vec4, kPaletteSize>;

/// The palette of files without an RGBA chunk: a 6x6x6 cube of colours from white down, without its black,
/// then ramps of red, green, blue and grey.
Palette defaultPalette();

/// Reads chunk RGBA, whose entry i is the colour of voxel index i + 1. The last entry is unused and may be
/// missing (1020 bytes).
Result<Palette> readPalette(Chunk& chunk);

/// Chunk IMAP: the order in which MagicaVoxel shows the palette. It changes no colour, so it is checked and
/// dropped. Diagnostics: vox-imap-invalid.
void checkIndexMap(Chunk& chunk, Diagnostics& diagnostics);

}  // namespace pfvox::import::vox
