// Fields: a cursor over the bytes of a VDB file that turns every shortage into an error with place and
// structure.
#pragma once

#include <cstdint>
#include <optional>
#include <pfvox/error.hpp>
#include <span>
#include <string>

#include "import/vdb/pfvox_metadata.hpp"
#include "io/byte_cursor.hpp"

namespace pfvox::import::vdb {

/// What the 16-byte header of a blosc block says of its sizes.
struct BloscSizes {
    std::uint64_t rawBytes = 0;
    std::uint64_t packedBytes = 0;  ///< with the header
};
std::optional<BloscSizes> readBloscSizes(std::span<const std::byte> block);

class Fields {
  public:
    /// Precondition: `offset` lies in `bytes`, which begin with the file.
    Fields(std::span<const std::byte> bytes, std::uint64_t offset)
        : cursor_(bytes.subspan(static_cast<std::size_t>(offset)), offset) {}

    std::uint64_t offset() const { return cursor_.offset(); }
    std::size_t remaining() const { return cursor_.remaining(); }

    template <class T>
    Result<T> read(const char* context) {
        if (const auto value = cursor_.read<T>()) return *value;
        return failAt(ErrorCode::Truncated, offset(), context, "the file or the grid ends here");
    }

    Result<std::span<const std::byte>> take(std::uint64_t count, const char* context);
    Result<std::string> readString(const char* context);

    /// Steps over a metadata map: each entry has a name, a type name and a sized value.
    Result<void> skipMetadata(const char* context);
    /// The same, but keeps what pfvox itself wrote.
    Result<OwnMetadata> readMetadata(const char* context);

  private:
    Result<void> checkValue(const std::string& name, const std::string& type, std::uint32_t size) const;

    io::ByteCursor cursor_;
};

}  // namespace pfvox::import::vdb
