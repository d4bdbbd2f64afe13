#include "import/vox/chunks.hpp"

#include <fmt/format.h>
#include <algorithm>

namespace pfvox::import::vox {

namespace {

constexpr std::string_view kMagic = "VOX ";

struct ChunkHeader {
    std::string_view id;
    std::uint64_t offsetBytes = 0;
    std::uint64_t contentBytes = 0;
    std::uint64_t childrenBytes = 0;
};

std::string contextOf(std::string_view id) {
    return "chunk " + printableId(id);
}

/// Reads a chunk header and proves that content and children lie within what is left of `cursor`.
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
    if (header.contentBytes + header.childrenBytes > cursor.remaining()) {
        return failAt(
            ErrorCode::Truncated, offset, contextOf(idText),
            fmt::format("announces {} bytes, but only {} are left; the file is incomplete or damaged: get "
                        "it or export it again",
                        header.contentBytes + header.childrenBytes, cursor.remaining()));
    }
    return header;
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
    cursor.take(main.contentBytes);
    const auto children = cursor.sub(main.childrenBytes);
    if (cursor.remaining() != 0) {
        diagnostics.report(
            {.severity = Severity::Warning,
             .id = "vox-trailing-bytes",
             .message = fmt::format("{} bytes follow the end of MAIN and are ignored", cursor.remaining()),
             .offsetBytes = cursor.offset()});
    }
    return ChunkWalker(*children);
}

Result<std::optional<Chunk>> ChunkWalker::next() {
    if (children_.remaining() == 0) return std::optional<Chunk>{};
    PFVOX_TRY(const ChunkHeader, header, readHeader(children_));
    const auto content = children_.sub(header.contentBytes);
    children_.take(header.childrenBytes);
    return std::optional<Chunk>{Chunk(header.id, header.offsetBytes, *content)};
}

}  // namespace pfvox::import::vox
