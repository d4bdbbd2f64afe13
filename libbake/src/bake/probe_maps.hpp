// From what was traced to the maps of a probe file.
#pragma once

#include <pfvox/bake.hpp>

#include "bake/probe_tracer.hpp"

namespace pfvox::bake {

/// All maps that the resolution has.
ProbeData makeMaps(const TracedProbe& traced, const ProbeResolution& resolution, float momentRange);

}  // namespace pfvox::bake
