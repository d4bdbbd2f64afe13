#include "pf_probe/frame_codec.hpp"

#include <fmt/format.h>
#include <zstd.h>

#include <algorithm>
#include <array>
#include <memory>

#include "io/hash.hpp"

namespace pfvox::probe {

using probe_layout::FrameCodec;

namespace {

struct FreeContext {
    void operator()(ZSTD_CCtx* context) const { ZSTD_freeCCtx(context); }
    void operator()(ZSTD_DCtx* context) const { ZSTD_freeDCtx(context); }
};

/// Byte b of word i -> place b * n + i.
void splitPlanes(std::span<const std::byte> words, std::size_t wordBytes, std::span<std::byte> planes) {
    const std::size_t count = words.size() / wordBytes;
    for (std::size_t b = 0; b < wordBytes; ++b)
        for (std::size_t i = 0; i < count; ++i) planes[b * count + i] = words[i * wordBytes + b];
}

void joinPlanes(std::span<const std::byte> planes, std::size_t wordBytes, std::span<std::byte> words) {
    const std::size_t count = words.size() / wordBytes;
    for (std::size_t b = 0; b < wordBytes; ++b)
        for (std::size_t i = 0; i < count; ++i) words[i * wordBytes + b] = planes[b * count + i];
}

Result<std::vector<std::byte>> compress(std::span<const std::byte> raw, int level) {
    thread_local const std::unique_ptr<ZSTD_CCtx, FreeContext> context(ZSTD_createCCtx());
    std::vector<std::byte> packed(ZSTD_compressBound(raw.size()));
    ZSTD_CCtx_reset(context.get(), ZSTD_reset_session_and_parameters);
    ZSTD_CCtx_setParameter(context.get(), ZSTD_c_compressionLevel, level);
    const std::size_t size =
        ZSTD_compress2(context.get(), packed.data(), packed.size(), raw.data(), raw.size());
    if (ZSTD_isError(size) != 0)
        return fail(ErrorCode::Internal, fmt::format("zstd cannot compress: {}", ZSTD_getErrorName(size)));
    packed.resize(size);
    return packed;
}

Result<void> decompress(std::span<const std::byte> stored, std::span<std::byte> raw) {
    thread_local const std::unique_ptr<ZSTD_DCtx, FreeContext> context(ZSTD_createDCtx());
    if (ZSTD_getFrameContentSize(stored.data(), stored.size()) != raw.size())
        return fail(ErrorCode::BadStructure, "the zstd frame does not have the size of the map");
    const std::size_t size =
        ZSTD_decompressDCtx(context.get(), raw.data(), raw.size(), stored.data(), stored.size());
    if (ZSTD_isError(size) != 0 || size != raw.size()) {
        return fail(ErrorCode::ChecksumMismatch,
                    fmt::format("cannot be decompressed: {}",
                                ZSTD_isError(size) != 0 ? ZSTD_getErrorName(size) : "short frame"));
    }
    return {};
}

}  // namespace

Result<PackedBytes> packBytes(std::span<const std::byte> raw, int zstdLevel) {
    PFVOX_TRY(auto, packed, compress(raw, zstdLevel));
    if (packed.size() < raw.size()) return PackedBytes{layout::Codec::Zstd, std::move(packed)};
    return PackedBytes{layout::Codec::Raw, {raw.begin(), raw.end()}};
}

Result<probe_layout::Frame> packFrame(ProbeLayer layer, std::span<const std::byte> words, int zstdLevel,
                                      std::vector<std::byte>& stored) {
    std::vector<std::byte> planes(words.size());
    splitPlanes(words, wordBytesOf(layer), planes);
    PFVOX_TRY(const PackedBytes, packed, packBytes(planes, zstdLevel));
    const bool isSmaller = packed.codec == layout::Codec::Zstd;
    const auto bytes = isSmaller ? std::span<const std::byte>(packed.bytes) : words;
    stored.insert(stored.end(), bytes.begin(), bytes.end());
    return probe_layout::Frame{.storedBytes = static_cast<std::uint32_t>(bytes.size()),
                               .codec = isSmaller ? FrameCodec::Planes : FrameCodec::Raw,
                               .rawHash = io::xxh3_64(words)};
}

Result<void> unpackFrame(ProbeLayer layer, const probe_layout::Frame& frame,
                         std::span<const std::byte> stored, std::span<std::byte> words) {
    switch (frame.codec) {
        case FrameCodec::Raw:
            if (stored.size() != words.size())
                return fail(ErrorCode::BadStructure, "the frame does not have the size of the map");
            std::ranges::copy(stored, words.begin());
            break;
        case FrameCodec::Zstd:
            PFVOX_CHECK(decompress(stored, words));
            break;
        case FrameCodec::Planes: {
            std::vector<std::byte> planes(words.size());
            PFVOX_CHECK(decompress(stored, planes));
            joinPlanes(planes, wordBytesOf(layer), words);
            break;
        }
    }
    if (io::xxh3_64(words) != frame.rawHash)
        return fail(ErrorCode::ChecksumMismatch, "the bytes do not have the stored hash: damaged");
    return {};
}

namespace {
constexpr std::array<std::string_view, 3> kCodecNames{"raw", "zstd", "planes"};
}

std::string_view toString(FrameCodec codec) {
    return kCodecNames[static_cast<std::size_t>(codec)];
}

FrameCodec codecOf(std::string_view name) {
    return static_cast<FrameCodec>(std::ranges::find(kCodecNames, name) - kCodecNames.begin());
}

}  // namespace pfvox::probe
