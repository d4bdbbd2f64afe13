#include "import/svx/png_image.hpp"

#include <fmt/format.h>
#include <spng.h>

#include <cstring>
#include <memory>

namespace pfvox::import::svx {

namespace {

/// Deflate makes at most 1032 bytes of one.
constexpr std::uint64_t kMaxInflation = 1032;
/// For all chunks but the picture: text and color profiles are inflated by libspng although nobody asks for
/// them.
constexpr std::size_t kMaxChunkBytes = 1 << 20;
constexpr std::size_t kMaxChunkCacheBytes = 4 << 20;

struct FreeContext {
    void operator()(spng_ctx* context) const noexcept { spng_ctx_free(context); }
};

tl::unexpected<Error> pngError(int code) {
    const bool cut = code == SPNG_IO_EOF || code == SPNG_EIDAT_TOO_SHORT;
    const ErrorCode kind = code == SPNG_ESIGNATURE ? ErrorCode::BadMagic
                                                   : (cut ? ErrorCode::Truncated : ErrorCode::BadStructure);
    return fail(kind, fmt::format("the PNG is damaged: {}", spng_strerror(code)));
}

std::uint32_t channelsOf(std::uint8_t colorType) {
    switch (colorType) {
        case SPNG_COLOR_TYPE_TRUECOLOR:
            return 3;
        case SPNG_COLOR_TYPE_GRAYSCALE_ALPHA:
            return 2;
        case SPNG_COLOR_TYPE_TRUECOLOR_ALPHA:
            return 4;
        default:
            return 1;
    }
}

/// A PNG whose header fits the slice.
class PngReader {
  public:
    static Result<PngReader> open(std::span<const std::byte> png, ImageSize expected) {
        PngReader reader;
        reader.context_.reset(spng_ctx_new(0));
        spng_ctx* const context = reader.context_.get();
        if (context == nullptr) return fail(ErrorCode::Internal, "libspng gives no context");
        spng_set_chunk_limits(context, kMaxChunkBytes, kMaxChunkCacheBytes);
        if (const int code = spng_set_png_buffer(context, png.data(), png.size()); code != 0)
            return pngError(code);
        if (const int code = spng_get_ihdr(context, &reader.header_); code != 0) return pngError(code);
        const spng_ihdr& header = reader.header_;
        if (header.width != expected.width || header.height != expected.height) {
            return fail(
                ErrorCode::BadStructure,
                fmt::format("the slice is {} x {} pixels; the grid and its orientation ask for {} x {}",
                            header.width, header.height, expected.width, expected.height));
        }
        if (reader.rowBytes() * header.height / kMaxInflation > png.size()) {
            return fail(ErrorCode::BadStructure,
                        fmt::format("the PNG announces {} x {} pixels, more than its {} bytes can hold",
                                    header.width, header.height, png.size()));
        }
        return reader;
    }

    const spng_ihdr& header() const { return header_; }
    std::uint32_t channels() const { return channelsOf(header_.color_type); }
    /// Bytes of a row as stored.
    std::uint64_t rowBytes() const {
        return (std::uint64_t{header_.width} * channels() * header_.bit_depth + 7) / 8;
    }

    Result<void> decode(void* out, std::size_t sizeBytes, int format, int flags) {
        std::size_t needed = 0;
        if (const int code = spng_decoded_image_size(context_.get(), format, &needed); code != 0)
            return pngError(code);
        if (needed != sizeBytes)
            return fail(ErrorCode::Internal, "libspng wants an image buffer of another size");
        if (const int code = spng_decode_image(context_.get(), out, sizeBytes, format, flags); code != 0) {
            return pngError(code);
        }
        return {};
    }

    Result<spng_plte> palette() {
        spng_plte palette{};
        if (const int code = spng_get_plte(context_.get(), &palette); code != 0) return pngError(code);
        return palette;
    }

    bool hasTransparentColor() {
        spng_trns transparency{};
        return spng_get_trns(context_.get(), &transparency) == 0;
    }

  private:
    std::unique_ptr<spng_ctx, FreeContext> context_;
    spng_ihdr header_{};
};

/// The first sample of a pixel in a row as stored.
std::uint16_t firstSample(const std::byte* row, std::uint32_t column, std::uint32_t bitDepth,
                          std::uint32_t channels) {
    const std::size_t sample = std::size_t{column} * channels;
    if (bitDepth == 16) {
        std::uint16_t value;
        std::memcpy(&value, row + 2 * sample, sizeof(value));
        return value;
    }
    if (bitDepth == 8) return std::to_integer<std::uint16_t>(row[sample]);
    const std::size_t bit = sample * bitDepth;
    const auto shift = static_cast<unsigned>(8 - bitDepth - bit % 8);
    return static_cast<std::uint16_t>((std::to_integer<unsigned>(row[bit / 8]) >> shift) &
                                      ((1u << bitDepth) - 1));
}

}  // namespace

Result<ScalarImage> decodeScalarPng(std::span<const std::byte> png, ImageSize expected) {
    PFVOX_TRY(PngReader, reader, PngReader::open(png, expected));
    const spng_ihdr header = reader.header();
    const auto rowBytes = static_cast<std::size_t>(reader.rowBytes());
    std::vector<std::byte> raw(rowBytes * header.height);
    PFVOX_CHECK(reader.decode(raw.data(), raw.size(), SPNG_FMT_PNG, 0));

    ScalarImage image;
    image.bitDepth = header.bit_depth;
    image.values.resize(static_cast<std::size_t>(expected.pixels()));
    std::size_t pixel = 0;
    for (std::uint32_t row = 0; row < header.height; ++row) {
        const std::byte* bytes = raw.data() + row * rowBytes;
        for (std::uint32_t column = 0; column < header.width; ++column) {
            image.values[pixel++] = firstSample(bytes, column, header.bit_depth, reader.channels());
        }
    }
    if (header.color_type == SPNG_COLOR_TYPE_INDEXED) {
        PFVOX_TRY(const spng_plte, palette, reader.palette());
        for (std::uint16_t& value : image.values) {
            if (value >= palette.n_entries)
                return fail(ErrorCode::BadReference, "a pixel names no entry of the palette");
            value = palette.entries[value].red;
        }
        image.bitDepth = 8;
    }
    image.maximum = static_cast<std::uint16_t>((1u << image.bitDepth) - 1);
    return image;
}

Result<ColorImage> decodeColorPng(std::span<const std::byte> png, ImageSize expected) {
    PFVOX_TRY(PngReader, reader, PngReader::open(png, expected));
    ColorImage image;
    image.pixels.resize(static_cast<std::size_t>(expected.pixels()));
    static_assert(sizeof(glm::u8vec4) == 4);
    PFVOX_CHECK(
        reader.decode(image.pixels.data(), image.pixels.size() * 4, SPNG_FMT_RGBA8, SPNG_DECODE_TRNS));
    const std::uint8_t type = reader.header().color_type;
    image.hasAlpha = type == SPNG_COLOR_TYPE_TRUECOLOR_ALPHA || type == SPNG_COLOR_TYPE_GRAYSCALE_ALPHA ||
                     reader.hasTransparentColor();
    return image;
}

}  // namespace pfvox::import::svx
