// VoxChunkWriter: the container of a .vox file: chunks, strings and dictionaries.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace pfvox::vox_export {

using Dict = std::vector<std::pair<std::string, std::string>>;

/// The content of one chunk.
class Content {
  public:
    Content& i32(std::int64_t value);
    Content& byte(std::uint8_t value);
    Content& text(std::string_view value);
    Content& dict(const Dict& entries);
    std::span<const std::byte> bytes() const { return bytes_; }

  private:
    std::vector<std::byte> bytes_;
};

/// A file of chunks below MAIN.
class ChunkWriter {
  public:
    void add(std::string_view id, const Content& content);
    /// "VOX ", version 150, MAIN and everything that was added.
    std::vector<std::byte> finish() const;

  private:
    Content chunks_;
};

}  // namespace pfvox::vox_export
