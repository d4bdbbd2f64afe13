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

Visible join(Visible a, Visible b) {
    if (a == kNothing || a == b) return b;
    return b == kNothing ? a : kSeveral;
}

/// One region that has bricks or tiles.
class RegionHollower {
  public:
    RegionHollower(VoxelRegion& region, std::uint32_t index, const octree::OpacityGrid& opacity)
        : region_(region), index_(index), opacity_(opacity), hidden_(region.cellEnd()) {}

    HollowReport run() {
        lookUpwards();
        if (report_.hiddenVoxels == 0) return report_;
        filling_ = static_cast<MaterialIndex>(std::ranges::max_element(hiddenOf_) - hiddenOf_.begin());
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

    void countHidden(MaterialIndex material, std::uint64_t count) {
        if (hiddenOf_.size() <= material) hiddenOf_.resize(std::size_t{material} + 1);
        hiddenOf_[material] += count;
        report_.hiddenVoxels += count;
    }

    Visible lookAtBrick(const Brick& brick, const BrickMask& hidden) {
        Visible visible = kNothing;
        for (std::size_t w = 0; w < hidden.size(); ++w) {
            const MaterialIndex* materials = &brick.materials[64 * w];
            for (std::uint64_t bits = hidden[w]; bits != 0; bits &= bits - 1) {
                countHidden(materials[std::countr_zero(bits)], 1);
            }
            visible = join(visible, visibleIn(brick.occupancy[w] & ~hidden[w], materials));
        }
        return visible;
    }

    Visible lookAtTile(MaterialIndex material, const BrickMask& hidden) {
        std::uint64_t count = 0;
        for (const std::uint64_t word : hidden) count += static_cast<std::uint64_t>(std::popcount(word));
        if (count != 0) countHidden(material, count);
        return count == kBrickVoxels ? kNothing : visibleAs(material);
    }

    /// Fills hidden_ and levels_: level 0 has an entry for each cell, the last one entry for all.
    void lookUpwards() {
        levels_.emplace_back(region_.cellEnd(), kNothing);
        for (std::uint32_t c = 0; c < region_.cellEnd(); ++c) {
            const VoxelRegion::Cell cell = region_.cell(c);
            if (cell.empty()) continue;
            hidden_[c] = hiddenVoxels(c);
            levels_[0][c] = cell.brick != nullptr ? lookAtBrick(*cell.brick, hidden_[c])
                                                  : lookAtTile(*cell.material, hidden_[c]);
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
        if (visible == kSeveral && level > 0) {
            for (std::uint32_t k = 0; k < 8; ++k) fillDownwards(level - 1, 8 * at + k);
            return;
        }
        const std::uint32_t count = 1u << (3 * level);
        for (std::uint32_t c = at * count; c < (at + 1) * count; ++c) fillCell(c, visible);
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
    std::vector<std::uint64_t> hiddenOf_;  ///< hidden voxels of each material
    MaterialIndex filling_ = 0;
    HollowReport report_;
};

HollowReport hollowModel(VoxelModel& model, const std::vector<Material>& materials) {
    const octree::OpacityGrid opacity(model, materials);
    std::vector<HollowReport> reports(model.regions().size());
    tbb::parallel_for(std::size_t{0}, reports.size(), [&](std::size_t r) {
        VoxelRegion& region = *model.regions()[r];
        if (region.uniform() || region.cellEnd() == 0) return;  // one leaf, or none: nothing to gain
        reports[r] = RegionHollower(region, static_cast<std::uint32_t>(r), opacity).run();
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
