#include "octree/region_builder.hpp"

#include <algorithm>
#include <array>
#include <bit>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace pfvox::octree {

namespace {

/// Levels of the cell table: 32^3 cells are 5 levels of octree above the bricks.
constexpr std::uint32_t kCellLevels = kRegionEdgeLog2 - kBrickEdgeLog2;

/// Bit i = whether materials[i] equals the reference, for eight materials.
std::uint8_t equalLanes(const MaterialIndex* materials, MaterialIndex reference) {
#if defined(__SSE2__)
    const __m128i lanes = _mm_loadu_si128(reinterpret_cast<const __m128i*>(materials));
    const __m128i equal = _mm_cmpeq_epi16(lanes, _mm_set1_epi16(static_cast<short>(reference)));
    return static_cast<std::uint8_t>(_mm_movemask_epi8(_mm_packs_epi16(equal, _mm_setzero_si128())));
#else
    std::uint8_t mask = 0;
    for (unsigned i = 0; i < 8; ++i) mask |= static_cast<std::uint8_t>((materials[i] == reference) << i);
    return mask;
#endif
}

bool allEqual(const MaterialIndex* materials, std::size_t count) {
    const MaterialIndex reference = materials[0];
    for (std::size_t i = 0; i < count; i += 8) {
        if (equalLanes(materials + i, reference) != 0xff) return false;
    }
    return true;
}

/// The 2^3 voxels of one mask byte.
Slot buildOctet(std::uint8_t mask, const MaterialIndex* materials) {
    if (mask == 0) return {};
    const MaterialIndex reference = materials[std::countr_zero(mask)];
    const bool uniform = (equalLanes(materials, reference) & mask) == mask;
    if (uniform && mask == 0xff) return Slot::leaf(reference);
    Slot slot{.kind = Slot::Kind::Inner,
              .uniform = uniform,
              .material = reference,
              .validMask = mask,
              .leafMask = mask,
              .valueMask = mask};
    std::copy_n(materials, 8, slot.values.begin());
    return slot;
}

/// Lowest and highest set coordinate of 4^3 Morton-ordered bits along one axis (0 = x, 1 = y, 2 = z); -1 when
/// empty.
struct Span4 {
    int first = -1;
    int last = -1;
};
Span4 spanOf(std::uint64_t bits, unsigned axis) {
    constexpr std::uint64_t kLowBit[3] = {0x5555555555555555u, 0x3333333333333333u, 0x0f0f0f0f0f0f0f0fu};
    constexpr std::uint64_t kHighBit[3] = {0x00ff00ff00ff00ffu, 0x0000ffff0000ffffu, 0x00000000ffffffffu};
    Span4 span;
    for (int c = 0; c < 4; ++c) {
        const std::uint64_t low = (c & 1) != 0 ? ~kLowBit[axis] : kLowBit[axis];
        const std::uint64_t high = (c & 2) != 0 ? ~kHighBit[axis] : kHighBit[axis];
        if ((bits & low & high) == 0) continue;
        if (span.first < 0) span.first = c;
        span.last = c;
    }
    return span;
}

/// Tight box of a brick's voxels in brick coordinates.
VoxelBox boundsOf(const Brick& brick) {
    VoxelBox box;
    for (unsigned axis = 0; axis < 3; ++axis) {
        std::array<std::uint64_t, 2> half{};
        for (unsigned word = 0; word < 8; ++word) half[(word >> axis) & 1u] |= brick.occupancy[word];
        const auto a = static_cast<glm::length_t>(axis);
        for (int upper = 0; upper < 2; ++upper) {
            const Span4 span = spanOf(half[static_cast<std::size_t>(upper)], axis);
            if (span.first < 0) continue;
            box.min[a] = std::min(box.min[a], 4 * upper + span.first);
            box.max[a] = std::max(box.max[a], 4 * upper + span.last + 1);
        }
    }
    return box;
}

bool contains(const VoxelBox& outer, const VoxelBox& inner) {
    return glm::all(glm::lessThanEqual(outer.min, inner.min)) &&
           glm::all(glm::greaterThanEqual(outer.max, inner.max));
}

/// Number of voxels and their tight box, in model voxels.
void measure(const VoxelRegion& source, OctreeRegion& region) {
    const glm::ivec3 origin = source.coord() * kRegionEdge;
    if (source.uniform()) {
        region.voxelCount = std::uint64_t{1} << (3 * kRegionEdgeLog2);
        region.bounds = {origin, origin + kRegionEdge};
        return;
    }
    for (std::uint32_t c = 0; c < source.cellEnd(); ++c) {
        const VoxelRegion::Cell cell = source.cell(c);
        if (cell.empty()) continue;
        const glm::ivec3 corner = origin + glm::ivec3{mortonDecode(c)} * kBrickEdge;
        const VoxelBox whole{corner, corner + kBrickEdge};
        if (cell.material) {
            region.voxelCount += kBrickVoxels;
            region.bounds.include(whole);
            continue;
        }
        std::uint64_t count = 0;
        for (const std::uint64_t word : cell.brick->occupancy)
            count += static_cast<std::uint64_t>(std::popcount(word));
        region.voxelCount += count;
        if (count == 0 || contains(region.bounds, whole)) continue;
        const VoxelBox local = boundsOf(*cell.brick);
        region.bounds.include({corner + local.min, corner + local.max});
    }
}

}  // namespace

bool isEmpty(const VoxelRegion& region) {
    if (region.uniform()) return false;
    for (std::uint32_t c = 0; c < region.cellEnd(); ++c) {
        const VoxelRegion::Cell cell = region.cell(c);
        if (cell.material) return false;
        if (cell.brick == nullptr) continue;
        if (std::ranges::any_of(cell.brick->occupancy, [](std::uint64_t word) { return word != 0; }))
            return false;
    }
    return true;
}

Slot RegionBuilder::buildWord(std::uint64_t bits, const MaterialIndex* materials) {
    if (bits == 0) return {};
    if (~bits == 0 && allEqual(materials, 64)) return Slot::leaf(materials[0]);
    std::array<Slot, 8> children;
    for (unsigned k = 0; k < 8; ++k) {
        children[k] = buildOctet(static_cast<std::uint8_t>(bits >> (8 * k)), materials + 8 * k);
    }
    return writer_.combine(children);
}

Slot RegionBuilder::buildBrick(const Brick& brick) {
    std::array<Slot, 8> children;
    for (std::size_t k = 8; k-- > 0;) children[k] = buildWord(brick.occupancy[k], &brick.materials[64 * k]);
    return writer_.combine(children);
}

Slot RegionBuilder::buildCells(const VoxelRegion& source, std::uint32_t firstCell, std::uint32_t level) {
    if (firstCell >= source.cellEnd()) return {};
    if (level == kCellLevels) {
        const VoxelRegion::Cell cell = source.cell(firstCell);
        if (cell.material) return Slot::leaf(*cell.material);
        return cell.brick != nullptr ? buildBrick(*cell.brick) : Slot{};
    }
    const std::uint32_t cellsPerChild = 1u << (3 * (kCellLevels - level - 1));
    std::array<Slot, 8> children;
    for (std::uint32_t k = 8; k-- > 0;) {
        children[k] = buildCells(source, firstCell + k * cellsPerChild, level + 1);
    }
    return writer_.combine(children);
}

Result<OctreeRegion> RegionBuilder::build(const VoxelRegion& source, Extent extent,
                                          std::size_t materialCount) {
    writer_.clear();
    writer_.finish(source.uniform() ? Slot::leaf(*source.uniform()) : buildCells(source, 0, 0));

    OctreeRegion region;
    region.originVoxels = source.coord() * kRegionEdge;
    region.tree.depth = kRegionEdgeLog2;
    if (extent == Extent::Shrink) {
        for (const std::uint32_t slot : writer_.stripRoot(kRegionEdgeLog2 - 1)) {
            --region.tree.depth;
            region.originVoxels += glm::ivec3{mortonDecode(slot)} * (1 << region.tree.depth);
        }
    }
    PFVOX_CHECK(writer_.writeTree(region.tree));
    PFVOX_CHECK(writer_.writeAttributes(materialCount, region));
    measure(source, region);
    return region;
}

}  // namespace pfvox::octree
