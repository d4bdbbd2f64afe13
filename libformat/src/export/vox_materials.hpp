// A material as the MATL dictionary of MagicaVoxel (docs/import.md has the mapping back).
#pragma once

#include <pfvox/asset.hpp>

#include "export/vox_chunk_writer.hpp"

namespace pfvox::vox_export {

Dict matlOf(const Material& material);

}  // namespace pfvox::vox_export
