// OpacityGrid: which voxels of a model are opaque, and with that which faces of voxels can be seen at all.
//
// A face is covered when the voxel behind it is opaque (isOpaque in pfvox/asset.hpp). The grid refers to the
// bricks of the model, which must stay where they are; their materials may change as long as no voxel changes
// from opaque to transparent or back.
#pragma once

#include <deque>
#include <map>
#include <pfvox/voxel_model.hpp>
#include <vector>

#include "octree/brick_mask.hpp"

namespace pfvox::octree {

/// A cell of a model: the place of its region in VoxelModel::regions() and its Morton code there.
struct CellPlace {
    std::uint32_t region;
    std::uint32_t cell;
};

class OpacityGrid {
  public:
    /// Regions are read in parallel. A material that does not exist counts as transparent.
    OpacityGrid(const VoxelModel& model, const std::vector<Material>& materials);

    bool isOpaqueMaterial(MaterialIndex material) const { return opaqueMaterials_[material]; }

    /// The place in VoxelModel::regions() of the region with this coordinate. Precondition: it exists.
    std::uint32_t regionAt(glm::ivec3 coord) const { return indexOf_.at({coord.x, coord.y, coord.z}); }

    /// The opaque voxels of a cell.
    const BrickMask& opaque(CellPlace place) const;
    /// The opaque voxels of the cell beside this one; none where the model ends.
    const BrickMask& opaqueBeside(CellPlace place, unsigned face) const;
    /// The voxels of the cell, empty ones too, whose face in this direction is covered.
    BrickMask covered(CellPlace place, unsigned face) const {
        return neighborBits(opaque(place), opaqueBeside(place, face), face);
    }

  private:
    static constexpr std::uint32_t kNone = 0xffffffffu;

    struct Region {
        const BrickMask* whole = nullptr;     ///< of each cell, where the region is uniform
        std::vector<const BrickMask*> cells;  ///< by cell; cells behind are empty
        std::deque<BrickMask> mixed;          ///< of bricks with opaque and transparent voxels
        std::array<std::uint32_t, kFaces> beside{};
    };
    void findNeighbors(const VoxelModel& model);

    std::map<std::array<int, 3>, std::uint32_t> indexOf_;  ///< by region coordinate
    std::vector<bool> opaqueMaterials_;                    ///< by any 16-bit index
    std::vector<Region> regions_;
};

}  // namespace pfvox::octree
