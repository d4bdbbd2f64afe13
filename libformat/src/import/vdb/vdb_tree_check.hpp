// A walk over the stored tree of a grid before OpenVDB builds it.
//
// OpenVDB trusts a file: child masks decide how many nodes it allocates, a length field how many bytes it
// reads into a buffer of another size. This walk knows the size of everything beforehand, allocates nothing,
// and looks at the masks and lengths only, so it costs little.
//
// Source: OpenVDB's tree/RootNode.h, InternalNode.h, LeafNode*.h (readTopology, readBuffers) and
// io/Compression.h.
#pragma once

#include <cstdint>
#include <pfvox/error.hpp>
#include <pfvox/limits.hpp>
#include <span>

#include "import/vdb/vdb_header.hpp"

namespace pfvox::import::vdb {

/// Where the data of the grid ends. Grids that share the tree of another have none of their own.
/// Errors, with offset: Truncated, BadValue, BadStructure; UnsupportedFeature for types that cannot be
/// models; LimitExceeded when OpenVDB would need more than maxMemoryBytes.
Result<std::uint64_t> checkTree(std::span<const std::byte> bytes, const GridDescriptor& grid,
                                const Limits& limits);

}  // namespace pfvox::import::vdb
