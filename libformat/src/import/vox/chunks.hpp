// Chunks: the container of a MagicaVoxel file. 'VOX ', i32 version, then MAIN, whose children are all other
// chunks. A chunk is id[4], i32 content size N, i32 size of its children M, N bytes, M bytes, little endian.
//
// Sizes are checked against the bytes that enclose them before anything is read, so that no truncated chunk
// passes.
#pragma once

#include <optional>
#include <pfvox/error.hpp>
#include <span>
#include <string>
#include <string_view>

#include "import/vox/dict.hpp"
#include "io/byte_cursor.hpp"

namespace pfvox::import::vox {

/// One chunk while its content is read. Every failure names the chunk and its offset in the file.
class Chunk {
  public:
    Chunk(std::string_view id, std::uint64_t offsetBytes, io::ByteCursor content)
        : id_(id), offsetBytes_(offsetBytes), content_(content) {}

    /// Four characters as the file gives them: a view into its bytes.
    std::string_view id() const { return id_; }
    /// Where the chunk's header begins in the file.
    std::uint64_t offsetBytes() const { return offsetBytes_; }
    /// Bytes of content not read yet.
    std::size_t remaining() const { return content_.remaining(); }

    /// Readers of the next field; `what` names it in the message. Errors: Truncated; readCount and readString
    /// also BadValue for a negative size, and Truncated for a count of things that the bytes left cannot
    /// hold.
    Result<std::int32_t> readInt(std::string_view what);
    Result<float> readFloat(std::string_view what);
    Result<std::uint32_t> readCount(std::size_t bytesEach, std::string_view what);
    Result<std::span<const std::byte>> readBytes(std::uint64_t count, std::string_view what);
    Result<std::string_view> readString(std::string_view what);
    Result<Dict> readDict(std::string_view what);

    [[nodiscard]] tl::unexpected<Error> fail(ErrorCode code, std::string message) const;

  private:
    std::string_view id_;
    std::uint64_t offsetBytes_;
    io::ByteCursor content_;
};

/// The id with anything but printable ASCII shown as '?', for messages.
std::string printableId(std::string_view id);

/// Walks over the children of MAIN in file order. Chunks are believed more than the sizes of what holds them:
/// writers get those wrong, so chunks that are whole are read on.
class ChunkWalker {
  public:
    /// Checks the header and finds the first chunk. Errors: BadMagic, Truncated, BadStructure.
    /// Diagnostics: vox-version, vox-container-size.
    static Result<ChunkWalker> open(std::span<const std::byte> bytes, Diagnostics& diagnostics);

    /// The next chunk, or nothing at the end. Children of children are stepped over. Errors: BadValue for
    /// negative sizes, Truncated for a chunk whose content goes beyond the end of the file. Diagnostics:
    /// vox-container-size, vox-trailing-bytes.
    Result<std::optional<Chunk>> next();

  private:
    ChunkWalker(io::ByteCursor chunks, std::uint64_t announcedEnd, Diagnostics& diagnostics)
        : chunks_(chunks), announcedEnd_(announcedEnd), diagnostics_(&diagnostics) {}

    void stepOverChildren(std::string_view id, std::uint64_t offsetBytes, std::uint64_t bytes);

    io::ByteCursor chunks_;
    std::uint64_t announcedEnd_;  ///< of MAIN, as an offset in the file
    Diagnostics* diagnostics_;
    bool isPastEnd_ = false;
};

}  // namespace pfvox::import::vox
