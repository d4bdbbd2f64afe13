#include "pf_probe/frame_codec.hpp"

#include <fmt/format.h>
#include <zstd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "io/hash.hpp"
#include "pf_probe/predictor.hpp"

namespace pfvox::probe {

using probe_layout::FrameCodec;

namespace {

struct FreeContext {
    void operator()(ZSTD_CCtx* context) const { ZSTD_freeCCtx(context); }
    void operator()(ZSTD_DCtx* context) const { ZSTD_freeDCtx(context); }
};

/// Texels along a map of so many bytes.
std::uint32_t edgeOf(ProbeLayer layer, std::size_t bytes) {
    return static_cast<std::uint32_t>(
        std::lround(std::sqrt(static_cast<double>(bytes / wordBytesOf(layer)))));
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
    PFVOX_TRY(const auto, packed, compress(toPlanes(layer, words, edgeOf(layer, words.size())), zstdLevel));
    const bool isSmaller = packed.size() < words.size();
    const auto bytes = isSmaller ? std::span<const std::byte>(packed) : words;
    stored.insert(stored.end(), bytes.begin(), bytes.end());
    return probe_layout::Frame{.storedBytes = static_cast<std::uint32_t>(bytes.size()),
                               .codec = isSmaller ? FrameCodec::Predicted : FrameCodec::Raw,
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
        case FrameCodec::Predicted: {
            const std::uint32_t edge = edgeOf(layer, words.size());
            std::vector<std::byte> planes(planeBytes(layer, edge));
            PFVOX_CHECK(decompress(stored, planes));
            fromPlanes(layer, planes, edge, words);
            break;
        }
    }
    if (io::xxh3_64(words) != frame.rawHash)
        return fail(ErrorCode::ChecksumMismatch, "the bytes do not have the stored hash: damaged");
    return {};
}

namespace {
constexpr std::array<std::string_view, 2> kCodecNames{"raw", "predicted"};
}

std::string_view toString(FrameCodec codec) {
    return kCodecNames[static_cast<std::size_t>(codec)];
}

FrameCodec codecOf(std::string_view name) {
    return static_cast<FrameCodec>(std::ranges::find(kCodecNames, name) - kCodecNames.begin());
}

}  // namespace pfvox::probe
