// Points on the surfaces of a scene, for the proximity grid.
#pragma once

#include <pfvox/proximity.hpp>
#include <pfvox/scene.hpp>
#include <span>

#include "bake/placed_models.hpp"

namespace pfvox::bake {

/// How far surfaces may stand outside of the outermost probes and still have cells of their own, in steps of
/// the grid.
inline constexpr float kProximityReach = 1.0f;

/// The box that cells divide: that of all surfaces, as far as it lies within reach of the probes. Grids
/// seldom end where the walls stand, and a cell spent on empty space is a cell less where there is surface.
ProximityGrid proximityShape(const ProbeGrid& probes, const glm::uvec3& cells, const WorldBounds& surfaces);

/// Middles of the exposed faces of all voxels within the grid's box, and points near a face's rim that lie in
/// other cells than its middle. Of more than `most` samples, every n-th.
std::vector<SurfaceSample> surfaceSamples(std::span<const PlacedModel> models, const ProximityGrid& shape,
                                          std::uint64_t most = std::uint64_t{1} << 23);

}  // namespace pfvox::bake
