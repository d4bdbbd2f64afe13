// Courtyard: the demo scene, one file with many models, layers, turned and mirrored instances.
#pragma once

#include "vox_writer.hpp"

namespace pfvox::demo {

VoxScene makeCourtyard(const DemoPalette& palette);

}  // namespace pfvox::demo
