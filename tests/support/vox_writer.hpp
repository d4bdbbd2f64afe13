// The writer of .vox files under the names of the tests.
#pragma once

#include "export/vox_writer.hpp"

namespace pfvox::test {

using vox_file::voxBytes;
using vox_file::voxChunk;
using vox_file::VoxDict;
using vox_file::voxDict;
using vox_file::voxInts;
using vox_file::voxString;
using vox_file::VoxVoxel;
using vox_file::VoxWriter;

}  // namespace pfvox::test
