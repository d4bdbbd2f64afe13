// Where a probe can stand: how far the nearest solid is, and a free place near a grid point.
#pragma once

#include <pfvox/pf_probe.hpp>
#include <span>
#include <vector>

#include "bake/placed_models.hpp"

namespace pfvox::bake {

struct NearestSolid {
    double metres = 0.0;       ///< 0 inside; not beyond the limit of the search
    double voxelMetres = 0.0;  ///< shortest edge of a voxel there; 0 when nothing is within the limit
};

/// Asks the octrees themselves. Exact where transforms keep voxels rectangular; where they shear, distances
/// are those to the nearest point in the voxels' own axes, a little too long at most.
class SolidQuery {
  public:
    explicit SolidQuery(std::span<const PlacedModel> models);
    NearestSolid nearest(const glm::dvec3& point, double limitMetres) const;
    double coarsestVoxelMetres() const { return coarsestVoxel_; }

  private:
    struct Solid {
        const PlacedModel* placed = nullptr;
        double shortest = 0.0;  ///< no vector of the model becomes shorter than this times its length
        double voxelMetres = 0.0;
    };
    std::vector<Solid> solids_;
    double coarsestVoxel_ = 0.0;
};

struct Placement {
    ProbeState state = ProbeState::Active;
    glm::vec3 offset{0.0f};
};

/// The grid point if it is at least a voxel away from everything; else the best of a lattice of 7^3 places
/// within 0.45 steps: score = distance to the nearest solid, up to a quarter step, minus displacement; of
/// equals the first.
Placement placeProbe(const SolidQuery& solids, const ProbeGrid& grid, std::uint32_t probe, bool relocate);

}  // namespace pfvox::bake
