// What `bench/run-verify` bakes beside the demo scene: small, closed, each hard for probes in its own way.
#pragma once

#include "canvas.hpp"
#include "palette.hpp"

namespace pfvox::demo {

/// Three rooms with doors between them, 12.8 x 9.6 x 3.4 m: sun through windows, a lamp, a store that is lit
/// through its door only.
Canvas makeInterior(const DemoPalette& p);

/// A hall of 12.8 x 12.8 x 4.8 m: glowing metal in tubs and a runner, columns and blocks of metal, a
/// skylight.
Canvas makeFoundry(const DemoPalette& p);

}  // namespace pfvox::demo
