// Two passes a region. Upwards: the one material of the visible voxels of every cube, if there is one.
// Downwards: the largest cubes with at most one visible material are filled with it, hidden voxel by hidden
// voxel; tiles are only ever replaced by tiles.
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <numeric>
#include <pfvox/hollow.hpp>

#include "octree/opacity_grid.hpp"

namespace pfvox {

namespace {

using octree::BrickMask;
using octree::CellPlace;

/// What the visible voxels of a cube have in common: an opaque material, or one of these.
using Visible = std::uint32_t;
constexpr Visible kNothing = 0xffffffffu;  ///< there are none
constexpr Visible kSeveral = 0xfffffffeu;  ///< nothing that hidden voxels could take: several materials, or a
                                           ///< transparent one

/// Level of the cubes whose hidden voxels get one material: 64^3, about what the compressor of the values has
/// in view.
constexpr std::size_t kFillingLevel = 3;

std::uint64_t countBits(const BrickMask& mask) {
    std::uint64_t count = 0;
    for (const std::uint64_t word : mask) count += static_cast<std::uint64_t>(std::popcount(word));
    return count;
}

Visible join(Visible a, Visible b) {
    if (a == kNothing || a == b) return b;
    return b == kNothing ? a : kSeveral;
}

/// One region that has bricks or tiles.
class RegionHollower {
  public:
    RegionHollower(VoxelRegion& region, std::uint32_t index, const octree::OpacityGrid& opacity,
                   std::size_t materialCount)
        : region_(region),
          index_(index),
          opacity_(opacity),
          hidden_(region.cellEnd()),
          visibleOf_(materialCount),
          hiddenOf_(materialCount) {}

    HollowReport run() {
        lookUpwards();
        if (report_.hiddenVoxels == 0) return report_;
        fillDownwards(levels_.size() - 1, 0);
        return report_;
    }

  private:
    BrickMask hiddenVoxels(std::uint32_t cell) const {
        const CellPlace place{index_, cell};
        BrickMask hidden = opacity_.opaque(place);
        for (unsigned face = 0; face < octree::kFaces; ++face) {
            const BrickMask covered = opacity_.covered(place, face);
            for (std::size_t w = 0; w < hidden.size(); ++w) hidden[w] &= covered[w];
        }
        return hidden;
    }

    Visible visibleAs(MaterialIndex material) const {
        return opacity_.isOpaqueMaterial(material) ? material : kSeveral;
    }

    /// The visible material of up to 64 voxels.
    Visible visibleIn(std::uint64_t bits, const MaterialIndex* materials) const {
        if (bits == 0) return kNothing;
        const MaterialIndex first = materials[std::countr_zero(bits)];
        for (bits &= bits - 1; bits != 0; bits &= bits - 1) {
            if (materials[std::countr_zero(bits)] != first) return kSeveral;
        }
        return visibleAs(first);
    }

    Visible lookAt(const VoxelRegion::Cell& cell, const BrickMask& hidden) {
        const std::uint64_t count = countBits(hidden);
        report_.hiddenVoxels += count;
        if (count == kBrickVoxels) return kNothing;
        if (cell.material) return visibleAs(*cell.material);
        Visible visible = kNothing;
        for (std::size_t w = 0; w < hidden.size(); ++w) {
            visible = join(visible,
                           visibleIn(cell.brick->occupancy[w] & ~hidden[w], &cell.brick->materials[64 * w]));
        }
        return visible;
    }

    /// Fills hidden_ and levels_: level 0 has an entry for each cell, the last one entry for all.
    void lookUpwards() {
        levels_.emplace_back(region_.cellEnd(), kNothing);
        for (std::uint32_t c = 0; c < region_.cellEnd(); ++c) {
            const VoxelRegion::Cell cell = region_.cell(c);
            if (cell.empty()) continue;
            hidden_[c] = hiddenVoxels(c);
            levels_[0][c] = lookAt(cell, hidden_[c]);
        }
        while (levels_.back().size() > 1) {
            const std::vector<Visible>& below = levels_.back();
            std::vector<Visible> level(below.size() / 8, kNothing);
            for (std::size_t i = 0; i < below.size(); ++i) level[i / 8] = join(level[i / 8], below[i]);
            levels_.push_back(std::move(level));
        }
    }

    void fillDownwards(std::size_t level, std::uint32_t at) {
        const Visible visible = levels_[level][at];
        const bool split = visible == kSeveral && level > 0;
        const bool isRoot = level + 1 == levels_.size();
        if (level == kFillingLevel || (level > kFillingLevel ? !split : isRoot)) {
            chooseFilling(at << (3 * level), 1u << (3 * level));
        }
        if (split) {
            for (std::uint32_t k = 0; k < 8; ++k) fillDownwards(level - 1, 8 * at + k);
            return;
        }
        const std::uint32_t count = 1u << (3 * level);
        for (std::uint32_t c = at * count; c < (at + 1) * count; ++c) fillCell(c, visible);
    }

    /// The most frequent material of what is visible in a cube, so that its values have no material more than
    /// without the hidden ones; where nothing opaque is visible, of what is hidden.
    void chooseFilling(std::uint32_t firstCell, std::uint32_t count) {
        std::ranges::fill(visibleOf_, 0);
        std::ranges::fill(hiddenOf_, 0);
        for (std::uint32_t c = firstCell; c < firstCell + count; ++c) countMaterials(c);
        const auto mostFrequent = [&](const std::vector<std::uint32_t>& counts) {
            const auto most = std::ranges::max_element(counts);
            if (*most != 0) filling_ = static_cast<MaterialIndex>(most - counts.begin());
            return *most != 0;
        };
        if (!mostFrequent(visibleOf_)) mostFrequent(hiddenOf_);
    }

    void countMaterials(std::uint32_t c) {
        const VoxelRegion::Cell cell = region_.cell(c);
        if (cell.empty()) return;
        if (cell.material) {
            if (!opacity_.isOpaqueMaterial(*cell.material)) return;
            const auto hidden = static_cast<std::uint32_t>(countBits(hidden_[c]));
            hiddenOf_[*cell.material] += hidden;
            visibleOf_[*cell.material] += kBrickVoxels - hidden;
            return;
        }
        const BrickMask& opaque = opacity_.opaque({index_, c});
        for (std::size_t w = 0; w < opaque.size(); ++w) {
            const MaterialIndex* materials = &cell.brick->materials[64 * w];
            for (std::uint64_t bits = opaque[w]; bits != 0; bits &= bits - 1) {
                const int i = std::countr_zero(bits);
                ++(((hidden_[c][w] >> i) & 1u) != 0 ? hiddenOf_ : visibleOf_)[materials[i]];
            }
        }
    }

    /// `visible`: of the largest cube that holds the cell and has at most one visible material.
    void fillCell(std::uint32_t c, Visible visible) {
        const VoxelRegion::Cell cell = region_.cell(c);
        const MaterialIndex material =
            visible == kNothing || visible == kSeveral ? filling_ : static_cast<MaterialIndex>(visible);
        if (hidden_[c] == octree::kAllVoxels) {
            countChanged(cell, material);
            region_.fillCell(c, material);
        } else if (cell.brick != nullptr) {
            fillBrick(region_.brickAt(c), hidden_[c], visible);
        }
    }

    void countChanged(const VoxelRegion::Cell& cell, MaterialIndex material) {
        if (cell.material) {
            report_.changedVoxels += *cell.material == material ? 0u : unsigned{kBrickVoxels};
        } else {
            const auto same = std::ranges::count(cell.brick->materials, material);
            report_.changedVoxels += kBrickVoxels - static_cast<std::uint64_t>(same);
        }
    }

    void fillBrick(Brick& brick, const BrickMask& hidden, Visible visible) {
        for (std::size_t w = 0; w < hidden.size(); ++w) {
            if (hidden[w] == 0) continue;
            MaterialIndex* materials = &brick.materials[64 * w];
            const std::uint64_t seen = brick.occupancy[w] & ~hidden[w];
            const Visible inBlock = visible == kSeveral ? visibleIn(seen, materials) : visible;
            if (inBlock != kSeveral) {
                fillBits(hidden[w], materials, inBlock);
                continue;
            }
            for (unsigned shift = 0; shift < 64; shift += 8) {
                const std::uint64_t octet = std::uint64_t{0xff} << shift;
                fillBits(hidden[w] & octet, materials, visibleIn(seen & octet, materials));
            }
        }
    }

    void fillBits(std::uint64_t bits, MaterialIndex* materials, Visible visible) {
        const MaterialIndex material =
            visible == kNothing || visible == kSeveral ? filling_ : static_cast<MaterialIndex>(visible);
        for (; bits != 0; bits &= bits - 1) {
            MaterialIndex& voxel = materials[std::countr_zero(bits)];
            report_.changedVoxels += voxel == material ? 0 : 1;
            voxel = material;
        }
    }

    VoxelRegion& region_;
    std::uint32_t index_;
    const octree::OpacityGrid& opacity_;
    std::vector<BrickMask> hidden_;  ///< by cell
    std::vector<std::vector<Visible>> levels_;
    std::vector<std::uint32_t> visibleOf_;  ///< visible opaque voxels of each material in a cube
    std::vector<std::uint32_t> hiddenOf_;   ///< hidden ones
    MaterialIndex filling_ = 0;
    HollowReport report_;
};

HollowReport hollowModel(VoxelModel& model, const std::vector<Material>& materials) {
    const octree::OpacityGrid opacity(model, materials);
    std::vector<HollowReport> reports(model.regions().size());
    tbb::parallel_for(std::size_t{0}, reports.size(), [&](std::size_t r) {
        VoxelRegion& region = *model.regions()[r];
        if (region.uniform() || region.cellEnd() == 0) return;  // one leaf, or none: nothing to gain
        reports[r] = RegionHollower(region, static_cast<std::uint32_t>(r), opacity, materials.size()).run();
    });
    HollowReport sum;
    for (const HollowReport& report : reports) {
        sum.hiddenVoxels += report.hiddenVoxels;
        sum.changedVoxels += report.changedVoxels;
    }
    return sum;
}

}  // namespace

HollowReport hollowSolids(VoxelAsset& asset) {
    HollowReport sum;
    for (VoxelModel& model : asset.models) {
        const HollowReport report = hollowModel(model, asset.materials);
        sum.hiddenVoxels += report.hiddenVoxels;
        sum.changedVoxels += report.changedVoxels;
    }
    asset.hollowed = true;
    return sum;
}

}  // namespace pfvox
