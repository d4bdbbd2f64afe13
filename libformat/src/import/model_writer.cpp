#include "import/model_writer.hpp"

#include <array>
#include <bit>

namespace pfvox::import {

namespace {

constexpr int kCellsLog2 = kRegionEdgeLog2 - kBrickEdgeLog2;

/// Morton codes of the coordinates in a brick, spread for the x axis.
constexpr std::array<std::uint32_t, kBrickEdge> kSpread{0, 1, 8, 9, 64, 65, 72, 73};

constexpr std::uint32_t mortonInBrick(glm::ivec3 voxel) {
    const auto spread = [](int coordinate) {
        return kSpread[static_cast<std::size_t>(coordinate & (kBrickEdge - 1))];
    };
    return spread(voxel.x) | (spread(voxel.y) << 1) | (spread(voxel.z) << 2);
}

std::uint32_t cellMorton(glm::ivec3 cell) {
    return mortonEncode(glm::uvec3(cell & ((1 << kCellsLog2) - 1)));
}

std::uint64_t countVoxels(const VoxelRegion::Cell& cell) {
    if (cell.material) return kBrickVoxels;
    std::uint64_t count = 0;
    if (cell.brick == nullptr) return count;
    for (const std::uint64_t word : cell.brick->occupancy)
        count += static_cast<std::uint64_t>(std::popcount(word));
    return count;
}

}  // namespace

bool ModelWriter::set(glm::ivec3 voxel, MaterialIndex material) {
    const glm::ivec3 cell = voxel >> kBrickEdgeLog2;
    if (brick_ == nullptr || cell != cell_) findBrick(cell);
    const std::uint32_t morton = mortonInBrick(voxel);
    const bool replaces = brick_->occupied(morton);
    brick_->set(morton, material);
    return replaces;
}

std::uint64_t ModelWriter::fillCube(glm::ivec3 corner, int edge, MaterialIndex material) {
    const bool isRegion = edge == kRegionEdge && ((corner.x | corner.y | corner.z) & (kRegionEdge - 1)) == 0;
    if (isRegion) return fillRegion(model_.regionAt(corner >> kRegionEdgeLog2), material);
    std::uint64_t replaced = 0;
    const glm::ivec3 last = (corner + edge - 1) >> kBrickEdgeLog2;
    for (int z = corner.z >> kBrickEdgeLog2; z <= last.z; ++z)
        for (int y = corner.y >> kBrickEdgeLog2; y <= last.y; ++y)
            for (int x = corner.x >> kBrickEdgeLog2; x <= last.x; ++x) {
                const glm::ivec3 cellCorner = glm::ivec3{x, y, z} * kBrickEdge;
                const glm::ivec3 low = glm::max(corner, cellCorner);
                const glm::ivec3 high = glm::min(corner + edge, cellCorner + kBrickEdge);
                const bool whole = high - low == glm::ivec3{kBrickEdge};
                replaced += whole ? fillCell({x, y, z}, material) : setBox(low, high, material);
            }
    return replaced;
}

std::uint64_t ModelWriter::memoryBytes() const {
    return bricks_ * sizeof(Brick) + model_.regions().size() * kRegionCells * sizeof(std::uint32_t);
}

std::uint64_t ModelWriter::fillCell(glm::ivec3 cell, MaterialIndex material) {
    VoxelRegion& region = model_.regionAt(cell >> kCellsLog2);
    const std::uint64_t before = countVoxels(region.cell(cellMorton(cell)));
    region.fillCell(cellMorton(cell), material);
    brick_ = nullptr;
    return before;
}

std::uint64_t ModelWriter::fillRegion(VoxelRegion& region, MaterialIndex material) {
    std::uint64_t before = 0;
    for (std::uint32_t c = 0; c < region.cellEnd(); ++c) before += countVoxels(region.cell(c));
    region.fill(material);
    brick_ = nullptr;
    return before;
}

std::uint64_t ModelWriter::setBox(glm::ivec3 low, glm::ivec3 high, MaterialIndex material) {
    std::uint64_t replaced = 0;
    for (int z = low.z; z < high.z; ++z)
        for (int y = low.y; y < high.y; ++y)
            for (int x = low.x; x < high.x; ++x) replaced += set({x, y, z}, material) ? 1u : 0u;
    return replaced;
}

void ModelWriter::findBrick(glm::ivec3 cell) {
    VoxelRegion& region = model_.regionAt(cell >> kCellsLog2);
    const std::size_t before = region.brickCount();
    brick_ = &region.brickAt(cellMorton(cell));
    bricks_ += region.brickCount() - before;
    cell_ = cell;
}

}  // namespace pfvox::import
