// From what was traced to the maps of a probe file.
#pragma once

#include <pfvox/bake.hpp>

#include "bake/probe_tracer.hpp"

namespace pfvox::bake {

struct MapSettings {
    ProbeResolution resolution;
    float momentRange = 1.0f;
    float filterVoxelMetres = 0.0f;  ///< of the scene, for the light filter; 0 = none
};

/// All maps that the resolution has.
ProbeData makeMaps(const TracedProbe& traced, const MapSettings& settings);

}  // namespace pfvox::bake
