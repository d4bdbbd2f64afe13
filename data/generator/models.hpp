// Models: the things that stand in the demo scene. z is up, 10 voxels are a metre.
#pragma once

#include "canvas.hpp"
#include "palette.hpp"

namespace pfvox::demo {

// Plants (plants.cpp)
Canvas makeTree(const DemoPalette& p, std::uint32_t seed);
Canvas makeBlossomTree(const DemoPalette& p);
Canvas makePlanter(const DemoPalette& p);

// Ornaments (ornaments.cpp)
Canvas makeLamp(const DemoPalette& p);
Canvas makeStatue(const DemoPalette& p);
Canvas makeFountain(const DemoPalette& p);
Canvas makeBench(const DemoPalette& p);
Canvas makeMetalBall(const DemoPalette& p);
Canvas makeGlassBlock(const DemoPalette& p);
Canvas makeTable(const DemoPalette& p);

// Architecture (architecture.cpp, house.cpp)
Canvas makeGround(const DemoPalette& p);
Canvas makeArch(const DemoPalette& p);
Canvas makeStairs(const DemoPalette& p);
Canvas makeTower(const DemoPalette& p);
Canvas makeHouse(const DemoPalette& p);

/// A floor between three walls, one red and one green with a window (example_terrace.cpp):
/// examples/game-assets
Canvas makeTerrace(const DemoPalette& p);

/// Courses of cut stone with joints: 8 voxels long, 4 high.
Brush ashlar(const DemoPalette& p, std::uint32_t seed);

/// Outer size of the stairs, whose landing meets the roof of the house.
inline constexpr int kHouseHeight = 40;

}  // namespace pfvox::demo
