// BrickMask: one bit for each voxel of a brick, and what its six neighbors are.
//
// Bit m of the 512 belongs to the voxel with Morton code m, as in Brick::occupancy: word w is the 4^3 block
// whose place in the brick has Morton code w. A step along an axis is a shift by a fixed distance for three
// of the four coordinates that a block has along it, and comes from the block beside it for the fourth:
//     coordinate 0 -> 1 and 2 -> 3: u = 1 << axis;   1 -> 2: 7u;   3 -> 0 of the next block: 9u
#pragma once

#include <array>
#include <cstdint>

namespace pfvox::octree {

using BrickMask = std::array<std::uint64_t, 8>;

inline constexpr BrickMask kNoVoxels{};
inline constexpr BrickMask kAllVoxels{~0ull, ~0ull, ~0ull, ~0ull, ~0ull, ~0ull, ~0ull, ~0ull};

/// Directions of the six faces of a voxel: 2 * axis + (towards larger coordinates ? 1 : 0).
inline constexpr unsigned kFaces = 6;
constexpr unsigned axisOf(unsigned face) {
    return face >> 1;
}
constexpr bool isUpward(unsigned face) {
    return (face & 1u) != 0;
}

/// The voxels of a 4^3 block with an even coordinate along the axis (0, 2), and with one in its lower half
/// (0, 1).
inline constexpr std::uint64_t kEven[3] = {0x5555555555555555u, 0x3333333333333333u, 0x0f0f0f0f0f0f0f0fu};
inline constexpr std::uint64_t kLower[3] = {0x00ff00ff00ff00ffu, 0x0000ffff0000ffffu, 0x00000000ffffffffu};

/// For each voxel of a block the bit of the voxel one step up the axis; `next` is the block above.
constexpr std::uint64_t stepUp(std::uint64_t block, std::uint64_t next, unsigned axis) {
    const unsigned u = 1u << axis;
    return ((block >> u) & kEven[axis]) | ((block >> (7 * u)) & ~kEven[axis] & kLower[axis]) |
           ((next << (9 * u)) & ~kEven[axis] & ~kLower[axis]);
}

/// For each voxel of a block the bit of the voxel one step down the axis; `previous` is the block below.
constexpr std::uint64_t stepDown(std::uint64_t block, std::uint64_t previous, unsigned axis) {
    const unsigned u = 1u << axis;
    return ((block << u) & ~kEven[axis]) | ((block << (7 * u)) & kEven[axis] & ~kLower[axis]) |
           ((previous >> (9 * u)) & kEven[axis] & kLower[axis]);
}

/// For each voxel of a brick the bit of its neighbor in the direction of `face`; `beside` is the brick
/// there.
constexpr BrickMask neighborBits(const BrickMask& brick, const BrickMask& beside, unsigned face) {
    const unsigned axis = axisOf(face);
    const std::size_t half = std::size_t{1} << axis;
    BrickMask bits{};
    for (std::size_t w = 0; w < brick.size(); ++w) {
        const bool upperHalf = (w & half) != 0;
        const std::uint64_t block = (upperHalf == isUpward(face) ? beside : brick)[w ^ half];
        bits[w] = isUpward(face) ? stepUp(brick[w], block, axis) : stepDown(brick[w], block, axis);
    }
    return bits;
}

}  // namespace pfvox::octree
