// Hashes of the file formats: xxh3 in its 64 and 128 bit forms.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

namespace pfvox::io {

std::uint64_t xxh3_64(std::span<const std::byte> bytes);

/// Streaming xxh3-128; the result is in canonical (big endian) byte order, the same on every machine.
class Xxh3_128 {
  public:
    Xxh3_128();
    ~Xxh3_128();
    Xxh3_128(const Xxh3_128&) = delete;
    Xxh3_128& operator=(const Xxh3_128&) = delete;

    void update(std::span<const std::byte> bytes);
    /// Adds the length of the text too, so that "ab" + "c" and "a" + "bc" differ.
    void update(std::string_view text);
    std::array<std::uint8_t, 16> digest() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace pfvox::io
