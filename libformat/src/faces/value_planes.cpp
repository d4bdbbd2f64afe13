#include "faces/value_planes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "faces/face_code.hpp"

namespace pfvox::faces {

namespace {

/// 0, -1, 1, -2, ... -> 0, 1, 2, 3, ...
std::uint32_t folded(int difference) {
    return difference >= 0 ? 2u * static_cast<std::uint32_t>(difference)
                           : 2u * static_cast<std::uint32_t>(-(difference + 1)) + 1u;
}
int unfolded(std::uint32_t residual) {
    return residual % 2 == 0 ? static_cast<int>(residual / 2) : -static_cast<int>(residual / 2) - 1;
}

/// The difference of two numbers of so many bits, around 0.
template <int kBits>
int wrapped(int difference) {
    constexpr int kHalf = 1 << (kBits - 1);
    return ((difference + kHalf) & (2 * kHalf - 1)) - kHalf;
}

tl::unexpected<Error> noValue(std::size_t i) {
    return fail(ErrorCode::BadValue, fmt::format("value {} is no light", i));
}

// Planes of FaceCodec::Quantized: light, low and high byte; red; blue.

void fillPlanes(std::span<const std::uint32_t> values, const std::array<std::uint8_t*, 4>& planes) {
    FaceCode before;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const FaceCode code = quantize(values[i]);
        const std::uint32_t light = folded(code.light - before.light);
        planes[0][i] = static_cast<std::uint8_t>(light);
        planes[1][i] = static_cast<std::uint8_t>(light >> 8);
        planes[2][i] = static_cast<std::uint8_t>(folded(wrapped<8>(code.red - before.red)));
        planes[3][i] = static_cast<std::uint8_t>(folded(wrapped<8>(code.blue - before.blue)));
        before = code;
    }
}

Result<void> takePlanes(const std::array<const std::uint8_t*, 4>& planes, std::span<std::uint32_t> values) {
    FaceCode before;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const int light =
            before.light + unfolded(planes[0][i] | static_cast<std::uint32_t>(planes[1][i]) << 8);
        if (light < 0 || light > static_cast<int>(kMaxLightCode)) return noValue(i);
        const FaceCode code{static_cast<std::uint16_t>(light),
                            static_cast<std::uint8_t>(before.red + unfolded(planes[2][i])),
                            static_cast<std::uint8_t>(before.blue + unfolded(planes[3][i]))};
        if (!isFaceCode(code)) return noValue(i);
        values[i] = dequantize(code);
        before = code;
    }
    return {};
}

// Planes of FaceCodec::Lossless: exponent; green, red and blue, low bytes; their bits 8.

constexpr std::uint32_t kMantissa = 511;
constexpr std::uint32_t kExponent = 31;

/// Red, green and blue of a word as they are with another exponent.
std::array<int, 3> foretold(std::uint32_t word, std::uint32_t exponent) {
    std::array<int, 3> mantissas{};
    const auto up = static_cast<int>(exponent) - static_cast<int>(word >> 27);
    for (std::uint32_t c = 0; c < 3; ++c) {
        const std::uint32_t m = word >> 9 * c & kMantissa;
        mantissas[c] = static_cast<int>(up >= 0 ? m >> up : std::min(kMantissa, m << std::min(-up, 9)));
    }
    return mantissas;
}

void fillPlanes(std::span<const std::uint32_t> values, const std::array<std::uint8_t*, 5>& planes) {
    std::uint32_t before = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const std::uint32_t word = values[i];
        const auto base = foretold(before, word >> 27);
        std::array<int, 3> differences{};
        for (std::uint32_t c = 0; c < 3; ++c)
            differences[c] = static_cast<int>(word >> 9 * c & kMantissa) - base[c];
        const std::array<std::uint32_t, 3> residuals{folded(wrapped<9>(differences[1])),
                                                     folded(wrapped<9>(differences[0] - differences[1])),
                                                     folded(wrapped<9>(differences[2] - differences[1]))};
        planes[0][i] = static_cast<std::uint8_t>(((word >> 27) - (before >> 27)) & kExponent);
        planes[4][i] = 0;
        for (std::uint32_t c = 0; c < 3; ++c) {
            planes[c + 1][i] = static_cast<std::uint8_t>(residuals[c]);
            planes[4][i] = static_cast<std::uint8_t>(planes[4][i] | (residuals[c] >> 8) << c);
        }
        before = word;
    }
}

Result<void> takePlanes(const std::array<const std::uint8_t*, 5>& planes, std::span<std::uint32_t> values) {
    std::uint32_t before = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const std::uint32_t exponent = ((before >> 27) + planes[0][i]) & kExponent;
        if (planes[0][i] > kExponent || exponent == kExponent || planes[4][i] > 7) return noValue(i);
        const auto base = foretold(before, exponent);
        const auto difference = [&](std::uint32_t c) {
            return unfolded(planes[c + 1][i] | (planes[4][i] >> c & 1u) << 8);
        };
        const int green = difference(0);
        const std::array<int, 3> mantissas{base[0] + green + difference(1), base[1] + green,
                                           base[2] + green + difference(2)};
        before = exponent << 27;
        for (std::uint32_t c = 0; c < 3; ++c)
            before |= (static_cast<std::uint32_t>(mantissas[c]) & kMantissa) << 9 * c;
        values[i] = before;
    }
    return {};
}

/// Where each plane begins.
template <std::size_t kCount, class Byte>
std::array<Byte*, kCount> planesOf(Byte* begin, std::size_t count) {
    std::array<Byte*, kCount> planes{};
    for (std::size_t i = 0; i < kCount; ++i) planes[i] = begin + i * count;
    return planes;
}

}  // namespace

std::vector<std::uint8_t> toPlanes(FaceCodec codec, std::span<const std::uint32_t> values) {
    std::vector<std::uint8_t> planes(planeCount(codec) * values.size());
    if (codec == FaceCodec::Quantized) {
        fillPlanes(values, planesOf<4>(planes.data(), values.size()));
    } else {
        fillPlanes(values, planesOf<5>(planes.data(), values.size()));
    }
    return planes;
}

Result<void> fromPlanes(FaceCodec codec, std::span<const std::byte> planes, std::span<std::uint32_t> values) {
    const auto* begin = reinterpret_cast<const std::uint8_t*>(planes.data());
    if (codec == FaceCodec::Quantized) return takePlanes(planesOf<4>(begin, values.size()), values);
    return takePlanes(planesOf<5>(begin, values.size()), values);
}

}  // namespace pfvox::faces
