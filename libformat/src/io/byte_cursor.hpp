// ByteCursor: reads little-endian values from untrusted bytes. Every read is checked; nothing is read past
// the end.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string_view>
#include <type_traits>

namespace pfvox::io {

static_assert(std::endian::native == std::endian::little, "pfvox runs on little-endian machines only");

class ByteCursor {
  public:
    /// `baseOffset`: where bytes[0] lies in the file, so that offset() can be given to the user.
    explicit ByteCursor(std::span<const std::byte> bytes, std::uint64_t baseOffset = 0)
        : bytes_(bytes), base_(baseOffset) {}

    std::uint64_t offset() const { return base_ + position_; }
    std::size_t remaining() const { return bytes_.size() - position_; }

    /// The next value, or nothing when fewer bytes are left; then the cursor stays.
    template <class T>
    requires std::is_trivially_copyable_v<T> std::optional<T> read() {
        if (remaining() < sizeof(T)) return std::nullopt;
        T value;
        std::memcpy(&value, bytes_.data() + position_, sizeof(T));
        position_ += sizeof(T);
        return value;
    }

    /// The next `count` bytes as they are, or nothing.
    std::optional<std::span<const std::byte>> take(std::uint64_t count) {
        if (count > remaining()) return std::nullopt;
        const auto part = bytes_.subspan(position_, static_cast<std::size_t>(count));
        position_ += static_cast<std::size_t>(count);
        return part;
    }

    /// A cursor over the next `count` bytes, which this one steps over; or nothing.
    std::optional<ByteCursor> sub(std::uint64_t count) {
        const std::uint64_t at = offset();
        const auto part = take(count);
        if (!part) return std::nullopt;
        return ByteCursor(*part, at);
    }

  private:
    std::span<const std::byte> bytes_;
    std::uint64_t base_ = 0;
    std::size_t position_ = 0;
};

inline std::string_view asText(std::span<const std::byte> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace pfvox::io
