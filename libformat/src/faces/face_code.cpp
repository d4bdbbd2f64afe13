#include "faces/face_code.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace pfvox::faces {

namespace {

constexpr std::uint32_t kOctave = 64;  ///< codes of one
constexpr std::uint32_t kMaxMantissa = 511;
constexpr std::uint32_t kMantissaBits = 9;
constexpr std::uint32_t kMaxExponent = 30;  ///< 31 is the escape of shared/faces.glsl.h
constexpr std::uint32_t kFractions = 255;
constexpr int kPowerBits = 12;

/// 64 log2 of each sum of mantissas, rounded. None is near a half, so that any library gives the same.
std::uint32_t logOf(std::uint32_t sum) {
    static const auto kTable = [] {
        std::array<std::uint16_t, 3 * kMaxMantissa + 1> table{};
        for (std::size_t i = 1; i < table.size(); ++i)
            table[i] = static_cast<std::uint16_t>(std::lround(kOctave * std::log2(static_cast<double>(i))));
        return table;
    }();
    return kTable[sum];
}

/// 2^(12 + i / 64), rounded. As above.
std::uint32_t powerOf(std::uint32_t i) {
    static const auto kTable = [] {
        std::array<std::uint32_t, kOctave> table{};
        for (std::size_t k = 0; k < table.size(); ++k)
            table[k] = static_cast<std::uint32_t>(
                std::lround(std::exp2(kPowerBits + static_cast<double>(k) / kOctave)));
        return table;
    }();
    return kTable[i];
}

std::uint8_t fractionOf(std::uint32_t part, std::uint32_t sum) {
    return static_cast<std::uint8_t>((2 * kFractions * part + sum) / (2 * sum));
}

/// Red, green and blue in 2^-36 / 255: below 2^61.
std::array<std::uint64_t, 3> partsOf(const FaceCode& code) {
    const std::uint32_t octave = (code.light - 1u) / kOctave;
    const std::uint64_t power = std::uint64_t{powerOf((code.light - 1u) % kOctave)} << octave;
    return {power * code.red, power * (kFractions - code.red - code.blue), power * code.blue};
}

std::uint64_t mantissaOf(std::uint64_t part, std::uint32_t exponent) {
    // floor((2 part + unit) / (2 unit)) with unit = 255 * 2^(kPowerBits + exponent), by a constant divisor.
    const std::uint32_t shift = kPowerBits + exponent;
    return ((2 * part + (std::uint64_t{kFractions} << shift)) >> (shift + 1)) / kFractions;
}

/// The code next to a word.
FaceCode nearest(std::uint32_t word) {
    const std::uint32_t red = word & kMaxMantissa;
    const std::uint32_t blue = word >> 18 & kMaxMantissa;
    const std::uint32_t sum = red + (word >> 9 & kMaxMantissa) + blue;
    if (sum == 0) return {};
    FaceCode code{.light = static_cast<std::uint16_t>(1 + kOctave * (word >> 27) + logOf(sum)),
                  .red = fractionOf(red, sum),
                  .blue = fractionOf(blue, sum)};
    // Two halves both round up.
    code.blue = static_cast<std::uint8_t>(std::min<std::uint32_t>(code.blue, kFractions - code.red));
    // Beside the largest words what rounds up would not be one.
    while (!isFaceCode(code)) --code.light;
    return code;
}

/// Whether mantissas are so fine that a word cannot be that of another code than the one next to it. Rounding
/// moves each by 1/2 and the sum by 3/2; a fraction f of the sum then moves by 255 (1/2 + 3/2 f) / sum steps,
/// which must be below a half. A little more for the table of powers.
bool isFine(std::uint32_t word) {
    const std::uint32_t red = word & kMaxMantissa;
    const std::uint32_t blue = word >> 18 & kMaxMantissa;
    const std::uint32_t sum = red + (word >> 9 & kMaxMantissa) + blue;
    return sum >= 290 && sum * sum > 290 * sum + 800 * std::max(red, blue);
}

/// A code that stands for exactly this word, if one near it does; else the one next to it.
FaceCode exact(std::uint32_t word) {
    const FaceCode center = nearest(word);
    if (center.light == 0 || isFine(word) || dequantize(center) == word) return center;
    for (int light = -1; light <= 1; ++light) {
        for (int red = -1; red <= 1; ++red) {
            for (int blue = -1; blue <= 1; ++blue) {
                const int r = center.red + red;
                const int b = center.blue + blue;
                const int l = center.light + light;
                if (r < 0 || b < 0 || r + b > static_cast<int>(kFractions) || l < 1) continue;
                const FaceCode code{static_cast<std::uint16_t>(l), static_cast<std::uint8_t>(r),
                                    static_cast<std::uint8_t>(b)};
                if (isFaceCode(code) && dequantize(code) == word) return code;
            }
        }
    }
    return center;
}

}  // namespace

// The mantissas of a word are coarser than the codes where one color outshines the others, so that the code
// next to what a code stands for may be its neighbor. The code of the word that will be read is the one that
// stays.
FaceCode quantize(std::uint32_t word) {
    return exact(dequantize(exact(word)));
}

bool isFaceCode(const FaceCode& code) {
    if (code.light == 0) return code.red == 0 && code.blue == 0;
    if (code.light > kMaxLightCode || code.red + code.blue > static_cast<int>(kFractions)) return false;
    const auto parts = partsOf(code);
    return mantissaOf(*std::ranges::max_element(parts), kMaxExponent) <= kMaxMantissa;
}

std::uint32_t dequantize(const FaceCode& code) {
    if (code.light == 0) return 0;
    const auto parts = partsOf(code);
    const std::uint64_t largest = *std::ranges::max_element(parts);
    const auto whole = static_cast<std::uint32_t>(std::bit_width((largest / kFractions) >> kPowerBits));
    std::uint32_t exponent = std::max(whole, kMantissaBits) - kMantissaBits;
    if (mantissaOf(largest, exponent) > kMaxMantissa) ++exponent;
    std::uint32_t word = exponent << 27;
    for (std::uint32_t i = 0; i < 3; ++i)
        word |= static_cast<std::uint32_t>(mantissaOf(parts[i], exponent)) << 9 * i;
    return word;
}

}  // namespace pfvox::faces
