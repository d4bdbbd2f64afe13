// PNG slices of SVX files, through libspng: every bit depth and color type, interlaced or not.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <pfvox/error.hpp>
#include <span>
#include <vector>

namespace pfvox::import::svx {

/// Pixels in rows from the top; row j begins at j * width.
struct ScalarImage {
    std::uint32_t bitDepth = 8;         ///< of one sample in the file
    std::uint16_t maximum = 255;        ///< the largest value that bitDepth allows
    std::vector<std::uint16_t> values;  ///< first component: gray, or red
};

struct ColorImage {
    bool hasAlpha = false;
    std::vector<glm::u8vec4> pixels;  ///< sRGB as stored; 16-bit samples keep their upper byte
};

/// The size that a slice must have.
struct ImageSize {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::uint64_t pixels() const { return std::uint64_t{width} * height; }
};

/// Errors: BadStructure when the size differs, when the header announces more than its bytes can hold, or
/// when the PNG is damaged; Truncated; BadMagic. Nothing is allocated before the header was checked against
/// `expected`.
Result<ScalarImage> decodeScalarPng(std::span<const std::byte> png, ImageSize expected);
Result<ColorImage> decodeColorPng(std::span<const std::byte> png, ImageSize expected);

}  // namespace pfvox::import::svx
