// VdbArchive: grids as the bytes of a .vdb file, equal bytes for equal grids.
//
// OpenVDB throws; so does this. exportVdb() catches at its edge.
#pragma once

#include <openvdb/Grid.h>

#include <cstddef>
#include <vector>

namespace pfvox::vdb_export {

/// A file with grid offsets, compressed as OpenVDB does by default. Grids that share a tree store it once.
/// OpenVDB writes a random identifier into the header; a hash of all other bytes takes its place.
std::vector<std::byte> writeVdb(const openvdb::GridCPtrVec& grids);

}  // namespace pfvox::vdb_export
