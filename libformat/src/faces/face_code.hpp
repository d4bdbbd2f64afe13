// FaceCode: the quantized form of a value. Integers only, so that a file is read as the same words
// everywhere.
//
//     sum = red + green + blue; light = 64 log2(sum), red and blue as fractions of the sum in 1/255
#pragma once

#include <cstdint>

namespace pfvox::faces {

struct FaceCode {
    std::uint16_t light = 0;  ///< 0 = black, then red and blue are 0; else 1 + 64 log2(sum / 2^-24)
    std::uint8_t red = 0;
    std::uint8_t blue = 0;  ///< red + blue at most 255: the rest is green
    bool operator==(const FaceCode&) const = default;
};
inline constexpr std::uint32_t kMaxLightCode = 2598;  ///< of three mantissas of 511 at exponent 30

/// Whether it stands for a word: not all combinations do, and some are beyond the largest word.
bool isFaceCode(const FaceCode& code);

/// Precondition: the exponent is below 31. quantize(dequantize(c)) == c for each c that this returns.
FaceCode quantize(std::uint32_t word);
/// RGB9E5. Precondition: isFaceCode(code).
std::uint32_t dequantize(const FaceCode& code);

}  // namespace pfvox::faces
