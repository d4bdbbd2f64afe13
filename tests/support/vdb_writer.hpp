// VDB files made in memory with OpenVDB, and counts taken with its accessors only: the oracle of the VDB
// importer.
#pragma once

#include <openvdb/io/Archive.h>
#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>

#include <cstdint>
#include <sstream>
#include <string>

#include "support/import_helpers.hpp"

namespace pfvox::test {

namespace detail {
/// Opens Archive::write, so that files with grid offsets need no disk.
class MemoryArchive : public openvdb::io::Archive {
  public:
    using Archive::write;
};

inline Bytes bytesOf(const std::ostringstream& stream) {
    const std::string text = stream.str();
    const auto* data = reinterpret_cast<const std::byte*>(text.data());
    return {data, data + text.size()};
}
}  // namespace detail

/// A file as File::write makes it: with offsets.
inline Bytes writeVdb(const openvdb::GridPtrVec& grids,
                      std::uint32_t compression = openvdb::io::COMPRESS_BLOSC |
                                                  openvdb::io::COMPRESS_ACTIVE_MASK) {
    openvdb::initialize();
    std::ostringstream stream(std::ios::binary);
    detail::MemoryArchive archive;
    archive.setCompression(compression);
    archive.write(stream, grids, /*seekable=*/true);
    return detail::bytesOf(stream);
}

/// A file as Stream::write makes it: without offsets.
inline Bytes writeVdbStream(const openvdb::GridPtrVec& grids) {
    openvdb::initialize();
    std::ostringstream stream(std::ios::binary);
    openvdb::io::Stream(stream).write(grids);
    return detail::bytesOf(stream);
}

/// Solid voxels of a scalar grid, asked one by one. Boxes of up to some 100 million voxels.
template <class GridT>
std::uint64_t countSolid(const GridT& grid, bool levelSet, double threshold = 0.0) {
    const auto accessor = grid.getConstAccessor();
    const openvdb::CoordBBox box = grid.evalActiveVoxelBoundingBox();
    std::uint64_t count = 0;
    if (box.empty()) return 0;
    for (auto it = box.begin(); it; ++it) {
        typename GridT::ValueType value{};
        const bool active = accessor.probeValue(*it, value);
        if (levelSet ? value < 0 : active && value > threshold) ++count;
    }
    return count;
}

}  // namespace pfvox::test
