// From what was traced to the maps of a probe file.
#pragma once

#include <pfvox/bake.hpp>
#include <span>
#include <vector>

#include "bake/probe_tracer.hpp"

namespace pfvox::bake {

struct TracedProbe {
    std::vector<shared::SeenTexel> seen;  ///< edges.depth squared
    std::vector<glm::vec3> light;         ///< I, edges.light squared
    TracedEdges edges;
};

/// All maps that the resolution has. Radiance for the irradiance map is that of Lambert surfaces: a texel's direct light
/// plus albedo times I.
ProbeData makeMaps(const TracedProbe& traced, const ProbeResolution& resolution, float momentRange);

}  // namespace pfvox::bake
