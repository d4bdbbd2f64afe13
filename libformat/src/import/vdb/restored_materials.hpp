// RestoredMaterials: the materials that an export of pfvox wrote into its grids, as materials of the asset
// again.
#pragma once

#include <pfvox/asset.hpp>
#include <vector>

#include "import/vdb/grid_voxels.hpp"
#include "import/vdb/pfvox_metadata.hpp"

namespace pfvox::import::vdb {

class RestoredMaterials {
  public:
    /// The table of a grid, by the index of its descriptor.
    void add(std::size_t grid, MaterialTable table) { tables_.insert_or_assign(grid, std::move(table)); }

    bool contains(std::size_t grid) const { return tables_.contains(grid); }

    /// Appends the materials of all tables in the order of their numbers, equal ones once. Grids of several
    /// files may be in one, so that a number may mean something else in every grid. Errors: LimitExceeded
    /// (maxMaterials).
    Result<void> appendTo(std::vector<Material>& materials, const Limits& limits);

    /// After appendTo(): what the numbers of a grid mean, or null.
    const KnownLabels* of(std::size_t grid) const {
        const auto found = known_.find(grid);
        return found == known_.end() ? nullptr : &found->second;
    }

  private:
    std::map<std::size_t, MaterialTable> tables_;
    std::map<std::size_t, KnownLabels> known_;
};

}  // namespace pfvox::import::vdb
