#include "octree/lod_measure.hpp"

#include <bit>

namespace pfvox::octree {

namespace {

/// Voxels of a block with coordinate 0 along the axis, where the shadow of a column is gathered.
constexpr std::uint64_t firstLayer(unsigned axis) {
    return kEven[axis] & kLower[axis];
}

/// The shadow of a block along an axis: the four voxels of a column lie at distances 0, 1, 8 and 9.
constexpr std::uint64_t shadowOf(std::uint64_t block, unsigned axis) {
    const unsigned u = 1u << axis;
    const std::uint64_t pairs = block | (block >> u);
    return (pairs | (pairs >> (8 * u))) & firstLayer(axis);
}

/// Place of an octant in the plane across the axis: its number without the bit of the axis.
constexpr std::size_t quadrantOf(std::size_t slot, unsigned axis) {
    const std::size_t below = slot & ((std::size_t{1} << axis) - 1);
    return below | ((slot >> (axis + 1)) << axis);
}

std::uint32_t countBits(std::uint64_t bits) {
    return static_cast<std::uint32_t>(std::popcount(bits));
}

/// Opaque voxels in the layer of a brick that touches the brick on the other side of `face`.
std::uint32_t coveredFaces(const BrickMask& beside, unsigned face) {
    const unsigned axis = axisOf(face);
    const std::uint64_t layer = isUpward(face) ? firstLayer(axis) : ~kEven[axis] & ~kLower[axis];
    std::uint32_t count = 0;
    for (std::size_t w = 0; w < beside.size(); ++w) {
        const bool upperHalf = ((w >> axis) & 1u) != 0;
        if (upperHalf != isUpward(face)) count += countBits(beside[w] & layer);
    }
    return count;
}

}  // namespace

FaceCounts::FaceCounts(const BrickMask& occupied, const OpacityGrid& opacity, CellPlace place) {
    std::array<BrickMask, kFaces> open;
    for (unsigned face = 0; face < kFaces; ++face) {
        const BrickMask covered = opacity.covered(place, face);
        for (std::size_t w = 0; w < covered.size(); ++w) open[face][w] = occupied[w] & ~covered[w];
    }
    const auto carry = [](std::uint64_t a, std::uint64_t b, std::uint64_t c) {
        return (a & b) | (c & (a | b));
    };
    // Two full adders of three faces each, and one for their carries: all 64 voxels of a block at once.
    for (std::size_t w = 0; w < occupied.size(); ++w) {
        const std::uint64_t ones1 = open[0][w] ^ open[1][w] ^ open[2][w];
        const std::uint64_t ones2 = open[3][w] ^ open[4][w] ^ open[5][w];
        const std::uint64_t twos1 = carry(open[0][w], open[1][w], open[2][w]);
        const std::uint64_t twos2 = carry(open[3][w], open[4][w], open[5][w]);
        const std::uint64_t twos3 = ones1 & ones2;
        planes_[0][w] = ones1 ^ ones2;
        planes_[1][w] = twos1 ^ twos2 ^ twos3;
        planes_[2][w] = carry(twos1, twos2, twos3);
    }
}

std::uint32_t FaceCounts::sum(std::size_t block, std::uint64_t voxels) const {
    return countBits(planes_[0][block] & voxels) + 2 * countBits(planes_[1][block] & voxels) +
           4 * countBits(planes_[2][block] & voxels);
}

std::uint32_t facesOfTile(const OpacityGrid& opacity, CellPlace first, std::uint32_t edgeLog2,
                          bool isOpaque) {
    const std::uint32_t cellsLog2 = edgeLog2 - kBrickEdgeLog2;
    const std::uint32_t cells = 1u << (3 * cellsLog2);
    const std::uint32_t edge = 1u << edgeLog2;
    // Voxels of a transparent tile do not cover each other.
    std::uint32_t faces = isOpaque ? 0 : kFaces * edge * edge * (edge - 1);
    for (unsigned face = 0; face < kFaces; ++face) {
        const std::uint32_t axisBits = (0x1249u << axisOf(face)) & (cells - 1);
        const std::uint32_t border = isUpward(face) ? axisBits : 0;
        for (std::uint32_t c = 0; c < cells; ++c) {
            if ((c & axisBits) != border) continue;
            const CellPlace place{first.region, first.cell + c};
            faces += kBrickEdge * kBrickEdge - coveredFaces(opacity.opaqueBeside(place, face), face);
        }
    }
    return faces;
}

Shadow::Shadow(std::uint32_t edgeLog2) {
    for (auto& words : words_) words.resize(std::size_t{1} << (2 * (edgeLog2 - 2)));
}

void Shadow::clear() {
    for (auto& words : words_) std::ranges::fill(words, 0);
}

void Shadow::set(const BrickMask& brick) {
    clear();
    for (unsigned axis = 0; axis < 3; ++axis) {
        for (std::size_t w = 0; w < brick.size(); ++w) {
            words_[axis][quadrantOf(w, axis)] |= shadowOf(brick[w], axis);
        }
    }
}

std::span<std::uint64_t> Shadow::quadrant(unsigned axis, std::uint32_t slot) {
    const std::size_t size = words_[axis].size() / 4;
    return std::span(words_[axis]).subspan(quadrantOf(slot, axis) * size, size);
}

void Shadow::addSolid(std::uint32_t slot) {
    for (unsigned axis = 0; axis < 3; ++axis) std::ranges::fill(quadrant(axis, slot), firstLayer(axis));
}

void Shadow::add(std::uint32_t slot, const Shadow& octant) {
    for (unsigned axis = 0; axis < 3; ++axis) {
        const std::span<std::uint64_t> target = quadrant(axis, slot);
        for (std::size_t i = 0; i < target.size(); ++i) target[i] |= octant.words_[axis][i];
    }
}

std::uint32_t Shadow::columns() const {
    std::uint32_t count = 0;
    for (const auto& words : words_) {
        for (const std::uint64_t word : words) count += countBits(word);
    }
    return count;
}

std::uint32_t shadowColumns(std::uint64_t block) {
    return countBits(shadowOf(block, 0)) + countBits(shadowOf(block, 1)) + countBits(shadowOf(block, 2));
}

std::uint32_t shadowColumnsOfOctet(std::uint64_t octet) {
    std::uint32_t count = 0;
    for (unsigned axis = 0; axis < 3; ++axis)
        count += countBits((octet | (octet >> (1u << axis))) & kEven[axis] & 0xffu);
    return count;
}

}  // namespace pfvox::octree
