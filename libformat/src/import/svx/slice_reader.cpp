#include "import/svx/slice_reader.hpp"

#include <fmt/format.h>

namespace pfvox::import::svx {

namespace {

/// What a PNG may weigh beyond its worst-case pixels: filter bytes, headers, text, a color profile.
constexpr std::uint64_t kPngOverheadBytes = 4 << 20;
constexpr std::uint64_t kMaxPixelBytes = 8;  // RGBA, 16 bits each

tl::unexpected<Error> inEntry(const std::string& name, Error error) {
    error.context = "entry " + name;
    return tl::make_unexpected(std::move(error));
}

}  // namespace

Result<void> SliceReader::checkPresence(const Channel& channel) {
    if (stack_.imageSize().pixels() > limits_.maxMemoryBytes / kMaxPixelBytes) {
        return fail(ErrorCode::LimitExceeded,
                    fmt::format("a slice of {} x {} pixels is too large (maxMemoryBytes)",
                                stack_.imageSize().width, stack_.imageSize().height));
    }
    std::string renamed;
    for (std::uint32_t slice = 0; slice < stack_.sliceCount(); ++slice) {
        const std::string name = channel.slices.nameOf(slice);
        const auto entry = archive_.find(name);
        if (!entry) {
            return fail(ErrorCode::BadReference,
                        fmt::format("slice {} of {} of channel {} is missing: the archive has no entry {}",
                                    slice, stack_.sliceCount(), channel.type, name));
        }
        if (!entry->exactName && renamed.empty())
            renamed = archive_.names()[static_cast<std::size_t>(entry->index)];
    }
    if (!renamed.empty()) {
        diagnostics_.warn(
            "svx-entry-names",
            fmt::format("slices of channel {} are named unlike the manifest says, for example {}; taken as "
                        "meant",
                        channel.type, renamed));
    }
    reportExtraSlices(channel);
    return {};
}

void SliceReader::reportExtraSlices(const Channel& channel) {
    std::size_t extra = 0;
    for (const std::string& name : archive_.names()) {
        const auto slice = channel.slices.sliceOf(name);
        if (slice && *slice >= stack_.sliceCount()) ++extra;
    }
    if (extra == 0) return;
    diagnostics_.warn(
        "svx-extra-slices",
        fmt::format("{} slices of channel {} lie beyond the grid and are left out", extra, channel.type));
}

Result<SliceReader::Slice> SliceReader::read(const Channel& channel, std::uint32_t slice) {
    Slice result{.name = channel.slices.nameOf(slice), .png = {}};
    const auto entry = archive_.find(result.name);
    if (!entry) return fail(ErrorCode::BadReference, "the archive has no entry " + result.name);
    const std::uint64_t maxBytes = stack_.imageSize().pixels() * kMaxPixelBytes + kPngOverheadBytes;
    PFVOX_TRY(auto, png, archive_.read(entry->index, maxBytes));
    result.png = std::move(png);
    return result;
}

Result<ScalarImage> SliceReader::scalar(const Channel& channel, std::uint32_t slice) {
    PFVOX_TRY(const Slice, file, read(channel, slice));
    auto image = decodeScalarPng(file.png, stack_.imageSize());
    if (!image) return inEntry(file.name, std::move(image).error());
    reportBits(channel, image->bitDepth);
    return image;
}

Result<ColorImage> SliceReader::color(const Channel& channel, std::uint32_t slice) {
    PFVOX_TRY(const Slice, file, read(channel, slice));
    auto image = decodeColorPng(file.png, stack_.imageSize());
    if (!image) return inEntry(file.name, std::move(image).error());
    return image;
}

void SliceReader::reportBits(const Channel& channel, std::uint32_t bitDepth) {
    if (bitsReported_ || !channel.bits || *channel.bits == bitDepth) return;
    bitsReported_ = true;
    diagnostics_.note(
        "svx-bits", fmt::format("channel {} announces {} bits, its slices have {}: values are scaled by the "
                                "depth of the slices",
                                channel.type, *channel.bits, bitDepth));
}

}  // namespace pfvox::import::svx
