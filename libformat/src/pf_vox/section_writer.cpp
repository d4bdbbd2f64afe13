#include "pf_vox/section_writer.hpp"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <zstd.h>

#include <fmt/format.h>
#include <algorithm>
#include <cstring>
#include <memory>
#include <span>

#include "io/hash.hpp"

namespace pfvox {

namespace {

struct FreeContext {
    void operator()(ZSTD_CCtx* context) const { ZSTD_freeCCtx(context); }
};
using CompressContext = std::unique_ptr<ZSTD_CCtx, FreeContext>;

/// A section with its final bytes, still without an offset.
struct Stored {
    layout::Section entry{};
    std::vector<std::uint8_t> bytes;
};

std::uint64_t alignUp(std::uint64_t value) {
    return (value + layout::kAlignment - 1) & ~(layout::kAlignment - 1);
}

/// Settings of the next frame. Values out of range are impossible here, so the results need no check.
void configure(ZSTD_CCtx* context, int level, Texture texture) {
    ZSTD_CCtx_reset(context, ZSTD_reset_session_and_parameters);
    ZSTD_CCtx_setParameter(context, ZSTD_c_compressionLevel, level);
    if (texture == Texture::LocalSymbols) {
        ZSTD_CCtx_setParameter(context, ZSTD_c_windowLog, 13);
        ZSTD_CCtx_setParameter(context, ZSTD_c_minMatch, 7);
    }
}

/// Compresses the bytes if that makes them fewer.
Result<void> compress(const SectionContent& section, ZSTD_CCtx* context, int level, Stored& stored) {
    std::vector<std::uint8_t> compressed(ZSTD_compressBound(stored.bytes.size()));
    configure(context, level, section.texture);
    const std::size_t size = ZSTD_compress2(context, compressed.data(), compressed.size(),
                                            stored.bytes.data(), stored.bytes.size());
    if (ZSTD_isError(size) != 0) {
        return fail(ErrorCode::Internal, fmt::format("zstd cannot compress section {}: {}", section.fourcc,
                                                     ZSTD_getErrorName(size)));
    }
    if (size >= stored.bytes.size()) return {};
    stored.entry.codec = layout::Codec::Zstd;
    stored.bytes.assign(compressed.begin(), compressed.begin() + static_cast<std::ptrdiff_t>(size));
    return {};
}

Result<Stored> store(SectionContent section, ZSTD_CCtx* context, int level) {
    Stored stored;
    std::ranges::copy(section.fourcc, stored.entry.fourcc.begin());
    stored.entry.flags = section.mustUnderstand ? layout::kSectionMustUnderstand : 0;
    stored.entry.region = section.region;
    stored.entry.rawBytes = section.raw.size();
    stored.entry.count = section.count;
    stored.entry.rawHash = io::xxh3_64(std::as_bytes(std::span(section.raw)));

    stored.bytes = std::move(section.raw);
    if (section.compress) PFVOX_CHECK(compress(section, context, level, stored));
    stored.entry.storedBytes = stored.bytes.size();
    return stored;
}

Result<std::vector<Stored>> storeAll(std::vector<SectionContent> sections, int level) {
    tbb::enumerable_thread_specific<CompressContext> contexts(
        [] { return CompressContext(ZSTD_createCCtx()); });
    std::vector<Stored> stored(sections.size());
    std::vector<std::optional<Error>> errors(sections.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, sections.size(), 1), [&](const auto& range) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
            auto result = store(std::move(sections[i]), contexts.local().get(), level);
            if (result) {
                stored[i] = *std::move(result);
            } else {
                errors[i] = std::move(result).error();
            }
        }
    });
    for (std::optional<Error>& error : errors) {
        if (error) return tl::make_unexpected(*std::move(error));
    }
    return stored;
}

}  // namespace

Result<std::vector<std::byte>> writeSections(std::vector<SectionContent> sections, const FileTraits& traits,
                                             const EncodeSettings& settings) {
    PFVOX_TRY(const auto, stored, storeAll(std::move(sections), settings.zstdLevel));
    if (stored.size() > 0xffffffffu / sizeof(layout::Section) - 1) {
        return fail(ErrorCode::LimitExceeded,
                    fmt::format("{} sections do not fit a section table", stored.size()));
    }
    layout::Header header{.magic = layout::kMagic,
                          .versionMajor = kPfVoxVersionMajor,
                          .versionMinor = kPfVoxVersionMinor,
                          .endianTag = layout::kEndianTag,
                          .requiredFeatures = traits.requiredFeatures,
                          .optionalFeatures = traits.optionalFeatures,
                          .tableOffset = sizeof(layout::Header),
                          .sectionCount = static_cast<std::uint32_t>(stored.size()),
                          .fileBytes = 0,
                          .headHash = 0,
                          .contentKey = settings.contentKey.bytes};
    const std::uint64_t headBytes = sizeof header + stored.size() * sizeof(layout::Section);
    std::uint64_t end = headBytes;
    std::vector<layout::Section> table;
    table.reserve(stored.size());
    for (const Stored& section : stored) {
        table.push_back(section.entry);
        table.back().offset = alignUp(end);
        end = table.back().offset + section.bytes.size();
    }
    header.fileBytes = end;

    std::vector<std::byte> file(end);
    std::memcpy(file.data(), &header, sizeof header);
    if (!table.empty())
        std::memcpy(file.data() + sizeof header, table.data(), table.size() * sizeof table[0]);
    header.headHash = io::xxh3_64(std::span(file).first(headBytes));
    std::memcpy(file.data(), &header, sizeof header);
    for (std::size_t i = 0; i < stored.size(); ++i) {
        if (!stored[i].bytes.empty()) {
            std::memcpy(file.data() + table[i].offset, stored[i].bytes.data(), stored[i].bytes.size());
        }
    }
    return file;
}

}  // namespace pfvox
