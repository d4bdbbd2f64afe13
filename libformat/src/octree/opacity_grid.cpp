#include "octree/opacity_grid.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>

namespace pfvox::octree {

namespace {

/// Bits of a cell's Morton code that belong to x: five of fifteen.
constexpr std::uint32_t kXBits = 0x1249;

/// Whether each of the 2^16 materials is opaque.
std::vector<bool> opaqueMaterials(const std::vector<Material>& materials) {
    std::vector<bool> table(std::size_t{1} << 16, false);
    for (std::size_t i = 0; i < std::min(materials.size(), table.size()); ++i)
        table[i] = isOpaque(materials[i]);
    return table;
}

BrickMask opaqueVoxels(const Brick& brick, const std::vector<bool>& isOpaqueMaterial) {
    BrickMask mask{};
    for (std::size_t w = 0; w < mask.size(); ++w) {
        for (std::uint64_t bits = brick.occupancy[w]; bits != 0; bits &= bits - 1) {
            const auto i = static_cast<std::size_t>(std::countr_zero(bits));
            mask[w] |= std::uint64_t{isOpaqueMaterial[brick.materials[64 * w + i]]} << i;
        }
    }
    return mask;
}

}  // namespace

OpacityGrid::OpacityGrid(const VoxelModel& model, const std::vector<Material>& materials)
    : opaqueMaterials_(opaqueMaterials(materials)), regions_(model.regions().size()) {
    const bool allOpaque = std::ranges::all_of(materials, isOpaque);
    const auto ofTile = [&](MaterialIndex m) { return opaqueMaterials_[m] ? &kAllVoxels : &kNoVoxels; };
    tbb::parallel_for(std::size_t{0}, regions_.size(), [&](std::size_t r) {
        const VoxelRegion& source = *model.regions()[r];
        Region& region = regions_[r];
        if (source.uniform()) {
            region.whole = ofTile(*source.uniform());
            return;
        }
        region.cells.resize(source.cellEnd(), &kNoVoxels);
        for (std::uint32_t c = 0; c < source.cellEnd(); ++c) {
            const VoxelRegion::Cell cell = source.cell(c);
            if (cell.material) region.cells[c] = ofTile(*cell.material);
            if (cell.brick == nullptr) continue;
            region.cells[c] = allOpaque
                                  ? &cell.brick->occupancy
                                  : &region.mixed.emplace_back(opaqueVoxels(*cell.brick, opaqueMaterials_));
        }
    });
    findNeighbors(model);
}

void OpacityGrid::findNeighbors(const VoxelModel& model) {
    const auto key = [](glm::ivec3 c) { return std::array{c.x, c.y, c.z}; };
    for (std::uint32_t r = 0; r < regions_.size(); ++r) indexOf_[key(model.regions()[r]->coord())] = r;
    for (std::uint32_t r = 0; r < regions_.size(); ++r) {
        for (unsigned face = 0; face < kFaces; ++face) {
            glm::ivec3 coord = model.regions()[r]->coord();
            coord[static_cast<glm::length_t>(axisOf(face))] += isUpward(face) ? 1 : -1;
            const auto found = indexOf_.find(key(coord));
            regions_[r].beside[face] = found == indexOf_.end() ? kNone : found->second;
        }
    }
}

const BrickMask& OpacityGrid::opaque(CellPlace place) const {
    const Region& region = regions_[place.region];
    if (region.whole != nullptr) return *region.whole;
    return place.cell < region.cells.size() ? *region.cells[place.cell] : kNoVoxels;
}

const BrickMask& OpacityGrid::opaqueBeside(CellPlace place, unsigned face) const {
    // Arithmetic on the bits of one axis: carries run through the bits of the others, which are set for + and
    // clear for -. The coordinate wraps where the region ends.
    const std::uint32_t unit = 1u << axisOf(face);
    const std::uint32_t bits = kXBits << axisOf(face);
    const std::uint32_t moved = isUpward(face) ? (place.cell | ~bits) + unit : (place.cell & bits) - unit;
    const std::uint32_t last = isUpward(face) ? bits : 0;
    const bool leaves = (place.cell & bits) == last;
    const CellPlace beside{.region = leaves ? regions_[place.region].beside[face] : place.region,
                           .cell = (moved & bits) | (place.cell & ~bits)};
    return beside.region == kNone ? kNoVoxels : opaque(beside);
}

}  // namespace pfvox::octree
