#include "import/vdb/vdb_reader.hpp"

#include <fmt/format.h>
#include <openvdb/io/Archive.h>
#include <openvdb/io/GridDescriptor.h>
#include <openvdb/openvdb.h>

#include <istream>
#include <streambuf>
#include <utility>

namespace pfvox::import::vdb {

namespace {

/// A read-only stream buffer over bytes that somebody else owns.
class SpanBuffer : public std::streambuf {
  public:
    explicit SpanBuffer(std::span<const std::byte> bytes) {
        // std::streambuf has only pointers to non-const; without overflow() and pbackfail() nothing is
        // written.
        char* begin = const_cast<char*>(reinterpret_cast<const char*>(bytes.data()));
        setg(begin, begin, begin + bytes.size());
    }

  protected:
    pos_type seekoff(off_type offset, std::ios_base::seekdir direction, std::ios_base::openmode) override {
        const off_type base = direction == std::ios_base::beg   ? 0
                              : direction == std::ios_base::cur ? gptr() - eback()
                                                                : egptr() - eback();
        const off_type target = base + offset;
        if (target < 0 || target > egptr() - eback()) return pos_type(off_type(-1));
        setg(eback(), eback() + target, egptr());
        return pos_type(target);
    }
    pos_type seekpos(pos_type position, std::ios_base::openmode which) override {
        return seekoff(off_type(position), std::ios_base::beg, which);
    }
};

/// Opens what OpenVDB keeps for its own File and Stream: reading one grid from any stream.
class GridArchive : public openvdb::io::Archive {
  public:
    using Archive::readGrid;
};

}  // namespace

class VdbReader::Stream {
  public:
    Stream(std::span<const std::byte> bytes, const VdbHeader& header) : buffer_(bytes), stream_(&buffer_) {
        // A short read must end the reading at once: OpenVDB itself would go on with what was in memory
        // before.
        stream_.exceptions(std::ios_base::badbit | std::ios_base::failbit | std::ios_base::eofbit);
        // Archive::readHeader would do this, but it prints when it does not know the version.
        metadata_->setFileVersion(header.fileVersion);
        metadata_->setLibraryVersion({header.libraryMajor, header.libraryMinor});
        openvdb::io::setStreamMetadataPtr(stream_, metadata_, /*transfer=*/true);
    }

    void seek(std::uint64_t position) { stream_.seekg(static_cast<std::streamoff>(position)); }

    /// Reads the descriptor at the current position and an empty grid of its type.
    openvdb::GridBase::Ptr readDescriptor(openvdb::io::GridDescriptor& descriptor) {
        return descriptor.read(stream_);
    }
    void readGrid(const openvdb::GridBase::Ptr& grid, const openvdb::io::GridDescriptor& descriptor) {
        GridArchive::readGrid(grid, descriptor, stream_);
    }

  private:
    openvdb::io::StreamMetadata::Ptr metadata_ = std::make_shared<openvdb::io::StreamMetadata>();
    SpanBuffer buffer_;
    std::istream stream_;
};

VdbReader::VdbReader(std::span<const std::byte> bytes, VdbHeader header) : header_(std::move(header)) {
    openvdb::initialize();
    stream_ = std::make_unique<Stream>(bytes, header_);
    for (std::size_t i = 0; i < header_.grids.size(); ++i) {
        if (header_.grids[i].instanceParent.empty()) treeOwners_.emplace(header_.grids[i].uniqueName, i);
    }
}

VdbReader::~VdbReader() = default;

openvdb::GridBase::Ptr VdbReader::read(std::size_t index) {
    const GridDescriptor& ours = header_.grids.at(index);
    stream_->seek(ours.descriptorPos);
    openvdb::io::GridDescriptor descriptor;
    openvdb::GridBase::Ptr grid = stream_->readDescriptor(descriptor);
    stream_->seek(ours.gridPos);
    stream_->readGrid(grid, descriptor);
    return grid;
}

std::size_t VdbReader::treeOwner(std::size_t index) const {
    const std::string& parent = header_.grids.at(index).instanceParent;
    if (parent.empty()) return index;
    if (const auto owner = treeOwners_.find(parent); owner != treeOwners_.end()) return owner->second;
    OPENVDB_THROW(openvdb::LookupError,
                  "the grid whose tree \"" + header_.grids[index].displayName + "\" shares is missing");
}

}  // namespace pfvox::import::vdb
