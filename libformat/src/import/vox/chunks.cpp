#include "import/vox/chunks.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cctype>

namespace pfvox::import::vox {

namespace {

constexpr std::string_view kMagic = "VOX ";
constexpr const char* kContainerSize = "vox-container-size";

/// Chunks that the format gives no children, whatever a file says.
constexpr std::array<std::string_view, 21> kChildless{"PACK", "SIZE", "XYZI", "TDCZ", "RGBA", "IMAP", "MATL",
                                                      "MATT", "nTRN", "nGRP", "nSHP", "LAYR", "rCAM", "NOTE",
                                                      "META", "rOBJ", "rLIT", "rAIR", "rLEN", "POST", "rDIS"};

struct ChunkHeader {
    std::string_view id;
    std::uint64_t offsetBytes = 0;
    std::uint64_t contentBytes = 0;
    std::uint64_t childrenBytes = 0;
};

std::string contextOf(std::string_view id) {
    return "chunk " + printableId(id);
}

/// Reads a chunk header and proves that its content lies within what is left of `cursor`.
Result<ChunkHeader> readHeader(io::ByteCursor& cursor) {
    const std::uint64_t offset = cursor.offset();
    const auto id = cursor.take(4);
    const auto contentBytes = cursor.read<std::int32_t>();
    const auto childrenBytes = cursor.read<std::int32_t>();
    if (!id || !contentBytes || !childrenBytes) {
        return failAt(ErrorCode::Truncated, offset, "chunk header",
                      "the file ends within it; it is incomplete: get it or export it again");
    }
    const std::string_view idText = io::asText(*id);
    if (*contentBytes < 0 || *childrenBytes < 0) {
        return failAt(ErrorCode::BadValue, offset, contextOf(idText),
                      fmt::format("negative size ({} bytes of content, {} of children); the file is damaged",
                                  *contentBytes, *childrenBytes));
    }
    const ChunkHeader header{.id = idText,
                             .offsetBytes = offset,
                             .contentBytes = static_cast<std::uint64_t>(*contentBytes),
                             .childrenBytes = static_cast<std::uint64_t>(*childrenBytes)};
    if (header.contentBytes > cursor.remaining()) {
        return failAt(
            ErrorCode::Truncated, offset, contextOf(idText),
            fmt::format("announces {} bytes, but only {} are left; the file is incomplete or damaged: get "
                        "it or export it again",
                        header.contentBytes, cursor.remaining()));
    }
    return header;
}

/// Whether a whole chunk with a plausible id begins here.
bool beginsChunk(io::ByteCursor cursor) {
    const auto id = cursor.take(4);
    const bool isId =
        id && std::ranges::all_of(io::asText(*id), [](unsigned char c) { return std::isalnum(c) != 0; });
    const auto contentBytes = cursor.read<std::int32_t>();
    const auto childrenBytes = cursor.read<std::int32_t>();
    return isId && contentBytes && childrenBytes && *contentBytes >= 0 && *childrenBytes >= 0 &&
           static_cast<std::uint64_t>(*contentBytes) <= cursor.remaining();
}

/// Whether children of this size can be stepped over: behind them the next chunk begins, or nothing.
bool endsWell(io::ByteCursor cursor, std::uint64_t childrenBytes) {
    return cursor.take(childrenBytes) && (cursor.remaining() == 0 || beginsChunk(cursor));
}

void warnAt(Diagnostics& diagnostics, const char* id, std::uint64_t offset, std::string message) {
    diagnostics.report(
        {.severity = Severity::Warning, .id = id, .message = std::move(message), .offsetBytes = offset});
}

}  // namespace

std::string printableId(std::string_view id) {
    std::string text(id);
    std::ranges::replace_if(
        text, [](char c) { return c < 32 || c > 126; }, '?');
    return text;
}

// --- Chunk ---

tl::unexpected<Error> Chunk::fail(ErrorCode code, std::string message) const {
    return failAt(code, offsetBytes_, contextOf(id_), std::move(message));
}

Result<std::int32_t> Chunk::readInt(std::string_view what) {
    const auto value = content_.read<std::int32_t>();
    if (!value) return fail(ErrorCode::Truncated, fmt::format("ends before {}", what));
    return *value;
}

Result<float> Chunk::readFloat(std::string_view what) {
    const auto value = content_.read<float>();
    if (!value) return fail(ErrorCode::Truncated, fmt::format("ends before {}", what));
    return *value;
}

Result<std::uint32_t> Chunk::readCount(std::size_t bytesEach, std::string_view what) {
    PFVOX_TRY(const std::int32_t, count, readInt(what));
    if (count < 0) return fail(ErrorCode::BadValue, fmt::format("{} is negative ({})", what, count));
    const auto needed = static_cast<std::uint64_t>(count) * bytesEach;
    if (needed > remaining()) {
        return fail(ErrorCode::Truncated,
                    fmt::format("{} is {}, which takes at least {} bytes, but {} are left", what, count,
                                needed, remaining()));
    }
    return static_cast<std::uint32_t>(count);
}

Result<std::span<const std::byte>> Chunk::readBytes(std::uint64_t count, std::string_view what) {
    const auto bytes = content_.take(count);
    if (!bytes) {
        return fail(ErrorCode::Truncated,
                    fmt::format("{} takes {} bytes, but {} are left", what, count, remaining()));
    }
    return *bytes;
}

Result<std::string_view> Chunk::readString(std::string_view what) {
    PFVOX_TRY(const std::uint32_t, length, readCount(1, what));
    PFVOX_TRY(const std::span<const std::byte>, bytes, readBytes(length, what));
    return io::asText(bytes);
}

Result<Dict> Chunk::readDict(std::string_view what) {
    constexpr std::size_t kLeastEntryBytes = 8;  // two empty strings
    PFVOX_TRY(const std::uint32_t, count, readCount(kLeastEntryBytes, what));
    Dict dict;
    for (std::uint32_t i = 0; i < count; ++i) {
        PFVOX_TRY(const std::string_view, key, readString("a key of " + std::string(what)));
        PFVOX_TRY(const std::string_view, value, readString("a value of " + std::string(what)));
        dict.add(key, value);
    }
    return dict;
}

// --- ChunkWalker ---

Result<ChunkWalker> ChunkWalker::open(std::span<const std::byte> bytes, Diagnostics& diagnostics) {
    io::ByteCursor cursor(bytes);
    const auto magic = cursor.take(kMagic.size());
    if (!magic || io::asText(*magic) != kMagic) {
        return failAt(
            ErrorCode::BadMagic, 0, "header",
            "does not start with \"VOX \" as MagicaVoxel files do; it was damaged on its way (converted as "
            "text?) or is no MagicaVoxel file");
    }
    const auto version = cursor.read<std::int32_t>();
    if (!version)
        return failAt(ErrorCode::Truncated, cursor.offset(), "header", "the file ends before the version");
    if (*version != 150 && *version != 200) {
        diagnostics.warn("vox-version",
                         fmt::format("version {} is unknown (150 and 200 are known); read as 200", *version));
    }

    PFVOX_TRY(const ChunkHeader, main, readHeader(cursor));
    if (main.id != "MAIN") {
        return failAt(ErrorCode::BadStructure, main.offsetBytes, contextOf(main.id),
                      "MAIN must be the first chunk; the file is damaged");
    }
    // Some writers count the children as content.
    const bool areContent = main.childrenBytes == 0 && beginsChunk(cursor);
    if (!areContent) cursor.take(main.contentBytes);
    const std::uint64_t announced = areContent ? main.contentBytes : main.childrenBytes;
    if (areContent || announced > cursor.remaining()) {
        warnAt(diagnostics, kContainerSize, main.offsetBytes,
               fmt::format("chunk MAIN announces {} bytes of content and {} of children, but {} follow; its "
                           "chunks are read as "
                           "far as they go, and may be incomplete",
                           main.contentBytes, main.childrenBytes, cursor.remaining()));
    }
    return ChunkWalker(cursor, cursor.offset() + announced, diagnostics);
}

Result<std::optional<Chunk>> ChunkWalker::next() {
    if (chunks_.remaining() == 0) return std::optional<Chunk>{};
    if (chunks_.offset() >= announcedEnd_ && !beginsChunk(chunks_)) {
        warnAt(*diagnostics_, "vox-trailing-bytes", chunks_.offset(),
               fmt::format("{} bytes follow the end of MAIN and are ignored", chunks_.remaining()));
        return std::optional<Chunk>{};
    }
    PFVOX_TRY(const ChunkHeader, header, readHeader(chunks_));
    const auto content = chunks_.sub(header.contentBytes);
    if (chunks_.offset() > announcedEnd_ && !isPastEnd_) {
        isPastEnd_ = true;
        warnAt(*diagnostics_, kContainerSize, header.offsetBytes,
               "chunks go on behind the end that MAIN announces; they are read, too");
    }
    if (header.childrenBytes != 0) stepOverChildren(header.id, header.offsetBytes, header.childrenBytes);
    return std::optional<Chunk>{Chunk(header.id, header.offsetBytes, *content)};
}

void ChunkWalker::stepOverChildren(std::string_view id, std::uint64_t offsetBytes, std::uint64_t bytes) {
    const bool isChildless = std::ranges::find(kChildless, id) != kChildless.end();
    if (endsWell(chunks_, bytes) && !(isChildless && beginsChunk(chunks_))) {
        chunks_.take(bytes);
        return;
    }
    warnAt(*diagnostics_, kContainerSize, offsetBytes,
           fmt::format(
               "chunk {} announces {} bytes of children, which are none; reading goes on behind its content",
               printableId(id), bytes));
}

}  // namespace pfvox::import::vox
