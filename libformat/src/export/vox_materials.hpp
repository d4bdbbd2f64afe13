// A material as the MATL dictionary of MagicaVoxel (docs/import.md has the mapping back).
#pragma once

#include <pfvox/asset.hpp>

#include "export/vox_writer.hpp"

namespace pfvox::vox_export {

vox_file::VoxDict matlOf(const Material& material);

}  // namespace pfvox::vox_export
