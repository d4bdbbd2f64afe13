// Comparing the materials of eight sibling voxels at once, working on the masks of eight nodes at once, and
// counting bits without a CPU that can.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <pfvox/voxel_model.hpp>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace pfvox::octree {

/// Bit i = whether materials[i] equals the reference, for eight materials.
inline std::uint32_t equalLanes(const MaterialIndex* materials, MaterialIndex reference) {
#if defined(__SSE2__)
    const __m128i lanes = _mm_loadu_si128(reinterpret_cast<const __m128i*>(materials));
    const __m128i equal = _mm_cmpeq_epi16(lanes, _mm_set1_epi16(static_cast<short>(reference)));
    return static_cast<std::uint32_t>(_mm_movemask_epi8(_mm_packs_epi16(equal, _mm_setzero_si128())));
#else
    std::uint32_t mask = 0;
    for (unsigned i = 0; i < 8; ++i) mask |= static_cast<std::uint32_t>(materials[i] == reference) << i;
    return mask;
#endif
}

/// Bit k = whether byte k of the word is not zero.
constexpr std::uint32_t nonZeroBytes(std::uint64_t word) {
    constexpr std::uint64_t kLow7 = 0x7f7f7f7f7f7f7f7fu;
    // The top bit of each byte, then all top bits side by side.
    const std::uint64_t top = (((word & kLow7) + kLow7) | word) & ~kLow7;
    return static_cast<std::uint32_t>(((top >> 7) * 0x0102040810204080u) >> 56);
}

/// Set bits of each byte value: std::popcount is a library call where the baseline has no such instruction.
inline constexpr std::array<std::uint8_t, 256> kBitCount = [] {
    std::array<std::uint8_t, 256> counts{};
    for (unsigned i = 0; i < 256; ++i) counts[i] = static_cast<std::uint8_t>(std::popcount(i));
    return counts;
}();

/// Byte k of the result = 0xff where bit k of the mask is set.
inline constexpr std::array<std::uint64_t, 256> kBytesOfBits = [] {
    std::array<std::uint64_t, 256> bytes{};
    for (unsigned mask = 0; mask < 256; ++mask)
        for (unsigned k = 0; k < 8; ++k)
            if ((mask >> k & 1u) != 0) bytes[mask] |= std::uint64_t{0xff} << (8 * k);
    return bytes;
}();

/// The set bits of each byte, in that byte.
constexpr std::uint64_t countInBytes(std::uint64_t word) {
    constexpr std::uint64_t k1 = 0x5555555555555555u;
    constexpr std::uint64_t k2 = 0x3333333333333333u;
    constexpr std::uint64_t k4 = 0x0f0f0f0f0f0f0f0fu;
    word -= (word >> 1) & k1;
    word = (word & k2) + ((word >> 2) & k2);
    return (word + (word >> 4)) & k4;
}

/// Byte k of the result = sum of the bytes 0 to k. Precondition: all together are below 256.
constexpr std::uint64_t sumsOfBytes(std::uint64_t bytes) {
    return bytes * 0x0101010101010101u;
}

/// Eight masks from bytes[first], as far as there are any; zeros behind them.
inline std::uint64_t eightBytes(const std::uint8_t* bytes, std::size_t first, std::size_t size) {
    std::uint64_t word = 0;
    if (size - first >= 8) {
        std::memcpy(&word, bytes + first, 8);
    } else {
        std::memcpy(&word, bytes + first, size - first);
    }
    return word;
}

/// Set bits of a brick's mask. The baseline of x86-64 has no popcount instruction, and a library call for
/// each word of each brick shows in profiles; adding up bytes of all eight words first does not.
inline std::uint32_t countBits(const std::array<std::uint64_t, 8>& words) {
    constexpr std::uint64_t k1 = 0x5555555555555555u;
    constexpr std::uint64_t k2 = 0x3333333333333333u;
    constexpr std::uint64_t k4 = 0x0f0f0f0f0f0f0f0fu;
    std::uint64_t bytes = 0;
    for (std::uint64_t w : words) {
        w -= (w >> 1) & k1;
        w = (w & k2) + ((w >> 2) & k2);
        bytes += (w + (w >> 4)) & k4;  // at most 8 * 8 in a byte
    }
    // A byte of the product would overflow past 255: add pairs as 16-bit numbers first.
    bytes = (bytes & 0x00ff00ff00ff00ffu) + ((bytes >> 8) & 0x00ff00ff00ff00ffu);
    return static_cast<std::uint32_t>((bytes * 0x0001000100010001u) >> 48);
}

}  // namespace pfvox::octree
