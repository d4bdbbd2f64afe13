#include "pf_probe/frame_codec.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "container/frame.hpp"
#include "io/hash.hpp"
#include "pf_probe/predictor.hpp"

namespace pfvox::probe {

using probe_layout::FrameCodec;

namespace {

/// Texels along a map of so many bytes.
std::uint32_t edgeOf(ProbeLayer layer, std::size_t bytes) {
    return static_cast<std::uint32_t>(
        std::lround(std::sqrt(static_cast<double>(bytes / wordBytesOf(layer)))));
}

}  // namespace

Result<probe_layout::Frame> packFrame(ProbeLayer layer, std::span<const std::byte> words, int zstdLevel,
                                      std::vector<std::byte>& stored) {
    PFVOX_TRY(const auto, packed,
              container::compressFrame(toPlanes(layer, words, edgeOf(layer, words.size())), zstdLevel,
                                       container::Texture::General, words.size()));
    const auto bytes = packed ? std::as_bytes(std::span(*packed)) : words;
    stored.insert(stored.end(), bytes.begin(), bytes.end());
    return probe_layout::Frame{.storedBytes = static_cast<std::uint32_t>(bytes.size()),
                               .codec = packed ? FrameCodec::Predicted : FrameCodec::Raw,
                               .rawHash = io::xxh3_64(words)};
}

Result<void> unpackFrame(ProbeLayer layer, const probe_layout::Frame& frame,
                         std::span<const std::byte> stored, std::span<std::byte> words,
                         container::MemoryBudget& budget) {
    switch (frame.codec) {
        case FrameCodec::Raw:
            if (stored.size() != words.size())
                return fail(ErrorCode::BadStructure, "the frame does not have the size of the map");
            std::ranges::copy(stored, words.begin());
            break;
        case FrameCodec::Predicted: {
            const std::uint32_t edge = edgeOf(layer, words.size());
            PFVOX_TRY(auto, planes, container::Array<std::byte>::make(budget, planeBytes(layer, edge)));
            PFVOX_CHECK(container::checkFrame(stored, stored.size(), planes.size()));
            PFVOX_CHECK(container::decompressFrame(stored, planes));
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
