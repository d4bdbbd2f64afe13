#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <pfvox/assert.hpp>
#include <pfvox/voxel_model.hpp>

#include "voxel_partition.hpp"

namespace pfvox {

namespace {

constexpr glm::ivec3 regionCoordOf(glm::ivec3 voxel) {
    return {voxel.x >> kRegionEdgeLog2, voxel.y >> kRegionEdgeLog2, voxel.z >> kRegionEdgeLog2};
}

constexpr std::uint32_t cellMortonOf(glm::ivec3 voxel) {
    constexpr std::uint32_t kMask = (1u << (kRegionEdgeLog2 - kBrickEdgeLog2)) - 1;
    return mortonEncode({(static_cast<std::uint32_t>(voxel.x) >> kBrickEdgeLog2) & kMask,
                         (static_cast<std::uint32_t>(voxel.y) >> kBrickEdgeLog2) & kMask,
                         (static_cast<std::uint32_t>(voxel.z) >> kBrickEdgeLog2) & kMask});
}

constexpr std::uint32_t voxelMortonOf(glm::ivec3 voxel) {
    return mortonEncode({static_cast<std::uint32_t>(voxel.x) & 7u, static_cast<std::uint32_t>(voxel.y) & 7u,
                         static_cast<std::uint32_t>(voxel.z) & 7u});
}

/// Cells in one word of the mask of used cells.
constexpr std::size_t kCellsPerBlock = 64;

/// Tight box of a brick's voxels in brick coordinates.
VoxelBox brickBounds(const Brick& brick) {
    VoxelBox box;
    for (std::uint32_t word = 0; word < 8; ++word) {
        for (std::uint64_t bits = brick.occupancy[word]; bits != 0; bits &= bits - 1) {
            const glm::ivec3 p{mortonDecode(word * 64 + static_cast<std::uint32_t>(std::countr_zero(bits)))};
            box.include({p, p + 1});
        }
    }
    return box;
}

}  // namespace

// --- VoxelRegion ---

std::uint32_t& VoxelRegion::entryAt(std::uint32_t cellMorton) {
    if (uniform_) {
        table_.assign(kRegionCells, kUniformFlag | *uniform_);
        used_.assign(kRegionCells / kCellsPerBlock, ~std::uint64_t{0});
        uniform_.reset();
    }
    if (cellMorton >= table_.size()) {
        std::size_t size = std::max<std::size_t>(table_.size(), 1);
        while (size <= cellMorton) size *= 8;
        table_.resize(size, kEmpty);
        used_.resize((size + kCellsPerBlock - 1) / kCellsPerBlock, 0);
    }
    used_[cellMorton / kCellsPerBlock] |= std::uint64_t{1} << (cellMorton % kCellsPerBlock);
    return table_[cellMorton];
}

Brick& VoxelRegion::brickAt(std::uint32_t cellMorton) {
    std::uint32_t& entry = entryAt(cellMorton);
    if (entry != kEmpty && (entry & kUniformFlag) == 0) return brick(entry);
    if (brickCount_ == chunks_.size() * kChunkBricks) {
        chunks_.push_back(std::make_unique_for_overwrite<Brick[]>(kChunkBricks));
    }
    Brick& fresh = brick(static_cast<std::uint32_t>(brickCount_));
    if (entry == kEmpty) {
        fresh.occupancy.fill(0);
    } else {
        fresh.occupancy.fill(~std::uint64_t{0});
        fresh.materials.fill(static_cast<MaterialIndex>(entry & 0xffffu));
    }
    entry = static_cast<std::uint32_t>(brickCount_++);
    return fresh;
}

void VoxelRegion::fillCell(std::uint32_t cellMorton, MaterialIndex material) {
    // A brick that this replaces stays allocated; tiles over voxels are rare.
    entryAt(cellMorton) = kUniformFlag | material;
}

void VoxelRegion::fill(MaterialIndex material) {
    table_.clear();
    used_.clear();
    chunks_.clear();
    brickCount_ = 0;
    uniform_ = material;
}

void VoxelRegion::insert(std::span<const RegionVoxel> voxels) {
    Brick* brick = nullptr;
    std::uint32_t cell = kEmpty;
    for (const RegionVoxel& voxel : voxels) {
        // Voxels come in runs, so most of them go to the brick of the one before.
        if (voxel.address / kBrickVoxels != cell) {
            cell = voxel.address / kBrickVoxels;
            const std::uint32_t entry = cell < table_.size() ? table_[cell] : kEmpty;
            brick =
                (entry & kUniformFlag) == 0 ? &this->brick(entry) : &brickAt(cell);  // kEmpty has the flag
        }
        brick->set(voxel.address % kBrickVoxels, voxel.material);
    }
}

void VoxelRegion::reset(glm::ivec3 coord) {
    coord_ = coord;
    uniform_.reset();
    for (std::size_t block = 0; block < used_.size(); ++block) {
        if (used_[block] == 0) continue;
        const std::size_t first = block * kCellsPerBlock;
        const std::size_t count = std::min<std::size_t>(kCellsPerBlock, table_.size() - first);
        std::fill_n(table_.begin() + static_cast<std::ptrdiff_t>(first), count, kEmpty);
        used_[block] = 0;
    }
    brickCount_ = 0;  // the chunks stay
}

std::uint64_t VoxelRegion::memoryBytes() const {
    return sizeof(*this) + table_.capacity() * sizeof(std::uint32_t) +
           used_.capacity() * sizeof(std::uint64_t) + chunks_.size() * kChunkBricks * sizeof(Brick);
}

// --- VoxelModel ---

std::size_t VoxelModel::CoordHash::operator()(glm::ivec3 c) const noexcept {
    const auto mix = [](std::uint64_t h, int v) {
        return (h ^ static_cast<std::uint32_t>(v)) * std::uint64_t{0x9e3779b97f4a7c15};
    };
    const std::uint64_t h = mix(mix(mix(0x243f6a8885a308d3u, c.x), c.y), c.z);
    return static_cast<std::size_t>(h ^ (h >> 32));
}

VoxelRegion* VoxelModel::findRegion(glm::ivec3 regionCoord) const {
    const auto found = indexOf_.find(regionCoord);
    return found == indexOf_.end() ? nullptr : regions_[found->second].get();
}

VoxelRegion& VoxelModel::regionAt(glm::ivec3 regionCoord) {
    if (last_ != nullptr && last_->coord() == regionCoord) return *last_;
    const auto [entry, isNew] = indexOf_.try_emplace(regionCoord, regions_.size());
    if (isNew) regions_.push_back(std::make_unique<VoxelRegion>(regionCoord));
    last_ = regions_[entry->second].get();
    return *last_;
}

void VoxelModel::insert(std::span<const PackedVoxel> voxels, glm::ivec3 origin) {
    const VoxelPartition partition(voxels, origin);
    std::vector<VoxelRegion*> targets;
    for (const auto& pieces : partition.parts()) targets.push_back(&regionAt(pieces.front().regionCoord));
    tbb::parallel_for(std::size_t{0}, targets.size(), [&](std::size_t i) {
        for (const VoxelPartition::Piece& piece : partition.parts()[i]) targets[i]->insert(piece.voxels);
    });
}

void VoxelModel::set(glm::ivec3 voxel, MaterialIndex material) {
    regionAt(regionCoordOf(voxel)).brickAt(cellMortonOf(voxel)).set(voxelMortonOf(voxel), material);
}

bool VoxelModel::clear(glm::ivec3 voxel) {
    if (!at(voxel)) return false;
    regionAt(regionCoordOf(voxel)).brickAt(cellMortonOf(voxel)).clear(voxelMortonOf(voxel));
    return true;
}

std::optional<MaterialIndex> VoxelModel::at(glm::ivec3 voxel) const {
    const VoxelRegion* region = findRegion(regionCoordOf(voxel));
    if (region == nullptr) return std::nullopt;
    const VoxelRegion::Cell cell = region->cell(cellMortonOf(voxel));
    if (cell.brick == nullptr) return cell.material;
    const std::uint32_t m = voxelMortonOf(voxel);
    if (!cell.brick->occupied(m)) return std::nullopt;
    return cell.brick->materials[m];
}

void VoxelModel::fillTile(glm::ivec3 corner, int edgeLog2, MaterialIndex material) {
    PFVOX_ASSERT(edgeLog2 >= kBrickEdgeLog2 && edgeLog2 <= 15);
    PFVOX_ASSERT(((corner.x | corner.y | corner.z) & ((1 << edgeLog2) - 1)) == 0);
    if (edgeLog2 >= kRegionEdgeLog2) {
        const int n = 1 << (edgeLog2 - kRegionEdgeLog2);
        const glm::ivec3 first = regionCoordOf(corner);
        for (int z = 0; z < n; ++z)
            for (int y = 0; y < n; ++y)
                for (int x = 0; x < n; ++x) regionAt(first + glm::ivec3{x, y, z}).fill(material);
        return;
    }
    // An aligned cube is a run of consecutive Morton codes.
    VoxelRegion& region = regionAt(regionCoordOf(corner));
    const std::uint32_t first = cellMortonOf(corner);
    const std::uint32_t count = 1u << (3 * (edgeLog2 - kBrickEdgeLog2));
    for (std::uint32_t c = first; c < first + count; ++c) region.fillCell(c, material);
}

std::uint64_t VoxelModel::voxelCount() const {
    std::uint64_t count = 0;
    for (const auto& region : regions_) {
        if (region->uniform()) {
            count += std::uint64_t{1} << (3 * kRegionEdgeLog2);
            continue;
        }
        for (std::uint32_t c = 0; c < region->cellEnd(); ++c) {
            const VoxelRegion::Cell cell = region->cell(c);
            if (cell.material) count += kBrickVoxels;
            if (cell.brick == nullptr) continue;
            for (const std::uint64_t word : cell.brick->occupancy) {
                count += static_cast<std::uint64_t>(std::popcount(word));
            }
        }
    }
    return count;
}

VoxelBox VoxelModel::bounds() const {
    VoxelBox box;
    for (const auto& region : regions_) {
        const glm::ivec3 origin = region->coord() * kRegionEdge;
        if (region->uniform()) {
            box.include({origin, origin + kRegionEdge});
            continue;
        }
        for (std::uint32_t c = 0; c < region->cellEnd(); ++c) {
            const VoxelRegion::Cell cell = region->cell(c);
            if (cell.empty()) continue;
            const glm::ivec3 corner = origin + glm::ivec3{mortonDecode(c)} * kBrickEdge;
            if (cell.material) {
                box.include({corner, corner + kBrickEdge});
            } else if (const VoxelBox local = brickBounds(*cell.brick); !local.empty()) {
                box.include({corner + local.min, corner + local.max});
            }
        }
    }
    return box;
}

std::uint64_t VoxelModel::memoryBytes() const {
    std::uint64_t bytes = sizeof(*this);
    for (const auto& region : regions_) bytes += region->memoryBytes();
    return bytes;
}

}  // namespace pfvox
