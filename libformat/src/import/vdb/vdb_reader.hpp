// VdbReader: single grids of a VDB file in memory, through OpenVDB.
//
// OpenVDB throws; so does read(). The importer catches at its edge (vdb_importer.cpp).
#pragma once

#include <openvdb/Grid.h>

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "import/vdb/vdb_header.hpp"

namespace pfvox::import::vdb {

class VdbReader {
  public:
    /// `bytes` must outlive the reader. A file without offsets is read as a whole here, any other grid by
    /// grid.
    VdbReader(std::span<const std::byte> bytes, VdbHeader header);
    ~VdbReader();
    VdbReader(const VdbReader&) = delete;
    VdbReader& operator=(const VdbReader&) = delete;

    const std::vector<GridDescriptor>& grids() const { return header_.grids; }

    /// One grid with its tree; of an instance only metadata and transform. Precondition: checkTree() accepts
    /// the grid.
    openvdb::GridBase::Ptr read(std::size_t index);

    /// The grid whose tree this one uses: itself, or its instance parent. Throws openvdb::LookupError.
    std::size_t treeOwner(std::size_t index) const;

  private:
    class Stream;

    VdbHeader header_;
    std::unordered_map<std::string, std::size_t>
        treeOwners_;  ///< grids with a tree of their own, by unique name
    std::unique_ptr<Stream> stream_;
};

}  // namespace pfvox::import::vdb
