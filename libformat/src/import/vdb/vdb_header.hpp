// The container of a VDB file: header, file metadata and one descriptor a grid, read by ourselves and checked
// before OpenVDB sees the file, because OpenVDB allocates what a length field says.
//
//     bytes -> [parseVdbHeader] -> VdbHeader -> checkTree -> VdbReader (OpenVDB) -> grid -> VoxelModel
//
// Source: OpenVDB's io/Archive.cc and io/GridDescriptor.cc; docs/import.md has the byte map.
#pragma once

#include <cstdint>
#include <pfvox/error.hpp>
#include <pfvox/limits.hpp>
#include <span>
#include <string>
#include <vector>

#include "import/vdb/pfvox_metadata.hpp"

namespace pfvox::import::vdb {

struct GridDescriptor {
    std::string uniqueName;         ///< with a suffix where several grids have one name
    std::string displayName;        ///< "density", "density[1]"
    std::string type;               ///< "Tree_float_5_4_3"
    bool isHalf = false;            ///< floats are stored with 16 bits
    std::string instanceParent;     ///< unique name of the grid whose tree this one shares, or empty
    std::string transformType;      ///< "UniformScaleMap", ...
    std::uint32_t compression = 0;  ///< flags: 1 zip, 2 active values only, 4 blosc
    std::uint64_t descriptorPos = 0;
    std::uint64_t gridPos = 0;  ///< compression flags, metadata, transform
    std::uint64_t treePos = 0;  ///< the tree; unset when the transform is of an unknown kind
    std::uint64_t endPos = 0;
    OwnMetadata own;  ///< what an export of pfvox noted

    /// The name without the suffix that makes it unique.
    std::string plainName() const;
    /// An entry of `own`, empty where it is absent.
    std::string_view ownText(std::string_view key) const;
};

struct VdbHeader {
    std::uint32_t fileVersion = 0;
    std::uint32_t libraryMajor = 0;
    std::uint32_t libraryMinor = 0;
    std::vector<GridDescriptor> grids;
};

/// Older files differ in what precedes each node; newer ones may differ in anything.
inline constexpr std::uint32_t kOldestFileVersion = 222;
inline constexpr std::uint32_t kNewestFileVersion = 225;

/// The first eight bytes of every VDB file.
inline constexpr std::int64_t kMagic = 0x56444220;

/// Every string, metadata value and offset up to the tree of each grid lies inside the file afterwards. Files
/// that were written to a stream have no offsets; there the trees are walked to find the next grid (errors of
/// checkTree). Errors, with offset: BadMagic, Truncated, BadValue, UnsupportedVersion, LimitExceeded
/// (maxModels).
Result<VdbHeader> parseVdbHeader(std::span<const std::byte> bytes, const Limits& limits,
                                 Diagnostics& diagnostics);

}  // namespace pfvox::import::vdb
