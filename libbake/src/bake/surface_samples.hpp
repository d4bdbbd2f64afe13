// Points on the surfaces of a scene, for the proximity grid.
#pragma once

#include <pfvox/proximity.hpp>
#include <span>

#include "bake/placed_models.hpp"

namespace pfvox::bake {

/// The box over which a proximity grid reaches: the space of the probes and half a step around it.
ProximityGrid proximityShape(const ProbeGrid& probes, const glm::uvec3& cells);

/// Middles of the exposed faces of all voxels within the grid's box. Of more than `most` faces, every n-th.
std::vector<SurfaceSample> surfaceSamples(std::span<const PlacedModel> models, const ProximityGrid& shape,
                                          std::uint64_t most = std::uint64_t{1} << 23);

}  // namespace pfvox::bake
