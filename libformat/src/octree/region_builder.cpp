#include "octree/region_builder.hpp"

#include <algorithm>
#include <array>
#include <bit>

#include "octree/lanes.hpp"

namespace pfvox::octree {

namespace {

/// A block of 4^3 cells has its mask of used cells in one word; three levels of octree are above the blocks.
constexpr std::uint32_t kBlockLevels = kRegionEdgeLog2 - kBrickEdgeLog2 - 2;
constexpr std::uint32_t kBlocks = 1u << (3 * kBlockLevels);

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

}  // namespace

bool isEmpty(const VoxelRegion& region) {
    if (region.uniform()) return false;
    for (std::uint32_t block = 0; block < kBlocks; ++block) {
        for (std::uint64_t bits = region.usedCells(block); bits != 0; bits &= bits - 1) {
            const auto cell = region.cell(block * 64 + static_cast<std::uint32_t>(std::countr_zero(bits)));
            if (cell.material) return false;
            if (std::ranges::any_of(cell.brick->occupancy, [](std::uint64_t word) { return word != 0; }))
                return false;
        }
    }
    return true;
}

void RegionBuilder::measureTile(std::uint32_t cell) {
    const glm::ivec3 corner = glm::ivec3{mortonDecode(cell)} * kBrickEdge;
    voxelCount_ += kBrickVoxels;
    bounds_.include({corner, corner + kBrickEdge});
}

void RegionBuilder::measureBrick(std::uint32_t cell, const Brick& brick) {
    const std::uint32_t count = countBits(brick.occupancy);
    const glm::ivec3 corner = glm::ivec3{mortonDecode(cell)} * kBrickEdge;
    voxelCount_ += count;
    if (count == 0 || contains(bounds_, {corner, corner + kBrickEdge})) return;
    const VoxelBox local = boundsOf(brick);
    bounds_.include({corner + local.min, corner + local.max});
}

Slot RegionBuilder::buildBrick(const Brick& brick) {
    std::array<Slot, 8> children;
    for (std::size_t k = 8; k-- > 0;)
        children[k] = writer_.combineVoxels(brick.occupancy[k], &brick.materials[64 * k]);
    return writer_.combine(children);
}

Slot RegionBuilder::buildCell(const VoxelRegion& source, std::uint32_t index) {
    const VoxelRegion::Cell cell = source.cell(index);
    if (cell.brick != nullptr) {
        measureBrick(index, *cell.brick);
        return buildBrick(*cell.brick);
    }
    measureTile(index);
    return Slot::leaf(*cell.material);
}

Slot RegionBuilder::buildBlock(const VoxelRegion& source, std::uint32_t block) {
    const std::uint64_t used = source.usedCells(block);
    if (used == 0) return {};
    std::array<Slot, 8> eighths;
    for (std::uint32_t k = 8; k-- > 0;) {
        const auto mask = static_cast<std::uint8_t>(used >> (8 * k));
        if (mask == 0) continue;
        std::array<Slot, 8> cells;
        for (std::uint32_t i = 8; i-- > 0;) {
            if (((mask >> i) & 1u) != 0) cells[i] = buildCell(source, 64 * block + 8 * k + i);
        }
        eighths[k] = writer_.combine(cells);
    }
    return writer_.combine(eighths);
}

Slot RegionBuilder::buildBlocks(const VoxelRegion& source, std::uint32_t firstBlock, std::uint32_t levels) {
    if (levels == 0) return buildBlock(source, firstBlock);
    const std::uint32_t blocksPerChild = 1u << (3 * (levels - 1));
    std::array<Slot, 8> children;
    for (std::uint32_t k = 8; k-- > 0;) {
        children[k] = buildBlocks(source, firstBlock + k * blocksPerChild, levels - 1);
    }
    return writer_.combine(children);
}

Slot RegionBuilder::buildRoot(const VoxelRegion& source) {
    voxelCount_ = 0;
    bounds_ = {};
    if (!source.uniform()) return buildBlocks(source, 0, kBlockLevels);
    voxelCount_ = std::uint64_t{1} << (3 * kRegionEdgeLog2);
    bounds_ = {glm::ivec3{0}, glm::ivec3{kRegionEdge}};
    return Slot::leaf(*source.uniform());
}

Result<OctreeRegion> RegionBuilder::build(const VoxelRegion& source, Extent extent, std::size_t materialCount,
                                          const std::shared_ptr<MemoryPool>& pool) {
    writer_.clear();
    writer_.finish(buildRoot(source));

    OctreeRegion region;
    region.usePool(pool);
    region.originVoxels = source.coord() * kRegionEdge;
    region.voxelCount = voxelCount_;
    region.bounds = {region.originVoxels + bounds_.min, region.originVoxels + bounds_.max};
    region.tree.depth = kRegionEdgeLog2;
    if (extent == Extent::Shrink) {
        for (const std::uint32_t slot : writer_.stripRoot(kRegionEdgeLog2 - 1)) {
            --region.tree.depth;
            region.originVoxels += glm::ivec3{mortonDecode(slot)} * (1 << region.tree.depth);
        }
    }
    PFVOX_CHECK(writer_.writeTree(region.tree));
    PFVOX_CHECK(writer_.writeAttributes(materialCount, region));
    return region;
}

}  // namespace pfvox::octree
