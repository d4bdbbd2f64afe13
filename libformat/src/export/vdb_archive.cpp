#include "export/vdb_archive.hpp"

#include <fmt/format.h>
#include <openvdb/io/Archive.h>
#include <openvdb/openvdb.h>

#include <algorithm>
#include <cstring>
#include <ostream>
#include <span>
#include <streambuf>
#include <string>

#include "io/hash.hpp"

namespace pfvox::vdb_export {

namespace {

/// Where the identifier stands: behind magic number, three versions and the flag of the offsets.
constexpr std::size_t kUuidAt = 8 + 4 + 4 + 4 + 1;
constexpr std::size_t kUuidChars = 36;

/// A stream buffer that grows and can be written anywhere: OpenVDB goes back to fill in offsets.
class ByteBuffer : public std::streambuf {
  public:
    std::vector<std::byte> take() { return std::move(bytes_); }

  protected:
    std::streamsize xsputn(const char* data, std::streamsize count) override {
        const auto size = static_cast<std::size_t>(count);
        if (position_ + size > bytes_.size()) {
            if (position_ + size > bytes_.capacity()) bytes_.reserve(2 * (position_ + size));
            bytes_.resize(position_ + size);
        }
        std::memcpy(bytes_.data() + position_, data, size);
        position_ += size;
        return count;
    }
    int_type overflow(int_type value) override {
        const char c = traits_type::to_char_type(value);
        xsputn(&c, 1);
        return value;
    }
    pos_type seekoff(off_type offset, std::ios_base::seekdir direction, std::ios_base::openmode) override {
        const auto base = static_cast<off_type>(direction == std::ios_base::beg   ? 0
                                                : direction == std::ios_base::cur ? position_
                                                                                  : bytes_.size());
        const off_type target = base + offset;
        if (target < 0 || target > static_cast<off_type>(bytes_.size())) return pos_type(off_type(-1));
        position_ = static_cast<std::size_t>(target);
        return pos_type(target);
    }
    pos_type seekpos(pos_type position, std::ios_base::openmode which) override {
        return seekoff(off_type(position), std::ios_base::beg, which);
    }

  private:
    std::vector<std::byte> bytes_;
    std::size_t position_ = 0;
};

/// Opens what OpenVDB keeps for its own File: writing to any stream that can seek.
class GridArchive : public openvdb::io::Archive {
  public:
    using Archive::write;
};

/// An identifier of version 8 (RFC 9562: of the maker's own making) from a hash of the file without it.
std::string uuidOf(std::span<const std::byte> bytes) {
    io::Xxh3_128 hash;
    hash.update(bytes.first(kUuidAt));
    hash.update(bytes.subspan(kUuidAt + kUuidChars));
    auto digest = hash.digest();
    digest[6] = static_cast<std::uint8_t>((digest[6] & 0x0fu) | 0x80u);
    digest[8] = static_cast<std::uint8_t>((digest[8] & 0x3fu) | 0x80u);
    std::string text;
    for (std::size_t i = 0; i < digest.size(); ++i) {
        if (i == 4 || i == 6 || i == 8 || i == 10) text += '-';
        text += fmt::format("{:02x}", digest[i]);
    }
    return text;
}

}  // namespace

std::vector<std::byte> writeVdb(const openvdb::GridCPtrVec& grids) {
    ByteBuffer buffer;
    std::ostream stream(&buffer);
    stream.exceptions(std::ios_base::badbit | std::ios_base::failbit);
    openvdb::MetaMap file;
    file.insertMeta("creator", openvdb::StringMetadata("pfvox"));
    GridArchive archive;
    archive.write(stream, grids, /*seekable=*/true, file);
    std::vector<std::byte> bytes = buffer.take();
    const std::string uuid = uuidOf(bytes);
    std::memcpy(bytes.data() + kUuidAt, uuid.data(), uuid.size());
    return bytes;
}

}  // namespace pfvox::vdb_export
