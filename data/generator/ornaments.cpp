#include "models.hpp"

namespace pfvox::demo {

Canvas makeLamp(const DemoPalette& p) {
    Canvas canvas({11, 11, 36});
    const glm::ivec2 axis{11, 11};
    const Brush iron = p.bronze.grain(31);
    canvas.cone({.centerHalf = axis, .bottomRadiusHalf = 8, .topRadiusHalf = 6, .zMin = 0, .zMax = 3},
                p.flagstone.grain(32));
    canvas.cone({.centerHalf = axis, .bottomRadiusHalf = 4, .topRadiusHalf = 2, .zMin = 3, .zMax = 24}, iron);
    canvas.ball({11, 11, 30}, 4, iron);
    canvas.box({{2, 2, 24}, {9, 9, 25}}, iron);
    canvas.box({{3, 3, 25}, {8, 8, 31}}, p.lampLight.grain(0));
    for (const int x : {2, 8}) {
        for (const int y : {2, 8}) canvas.box({{x, y, 25}, {x + 1, y + 1, 31}}, iron);
    }
    canvas.box({{1, 1, 31}, {10, 10, 32}}, iron);
    canvas.cone({.centerHalf = axis, .bottomRadiusHalf = 8, .topRadiusHalf = 1, .zMin = 32, .zMax = 36},
                iron);
    return canvas;
}

/// An armillary sphere: three golden rings about a steel ball, on a stepped plinth.
Canvas makeStatue(const DemoPalette& p) {
    Canvas canvas({33, 33, 56});
    const Brush stone = p.flagstone.patches(6, 41);
    canvas.box({{3, 3, 0}, {30, 30, 3}}, stone);
    canvas.box({{6, 6, 3}, {27, 27, 6}}, stone);
    canvas.box({{9, 9, 6}, {24, 24, 18}}, p.sandstone.patches(5, 42));
    canvas.box({{8, 8, 18}, {25, 25, 20}}, stone);
    canvas.cone({.centerHalf = {33, 33}, .bottomRadiusHalf = 10, .topRadiusHalf = 4, .zMin = 20, .zMax = 26},
                p.bronze.grain(43));
    const glm::ivec3 center{33, 33, 78};
    canvas.torus(center, {28, 3}, 0, p.gold.grain(44));
    canvas.torus(center, {28, 3}, 1, p.gold.grain(45));
    canvas.torus(center, {24, 3}, 2, p.bronze.grain(46));
    canvas.ball(center, 13, p.steel.grain(0));
    return canvas;
}

Canvas makeFountain(const DemoPalette& p) {
    Canvas canvas({41, 41, 26});
    const glm::ivec2 axis{41, 41};
    const Brush stone = p.sandstone.patches(4, 51);
    const Brush rim = p.flagstone.patches(4, 52);
    const auto disc = [&](int radiusHalf, int zMin, int zMax, const Brush& brush) {
        canvas.cone({.centerHalf = axis,
                     .bottomRadiusHalf = radiusHalf,
                     .topRadiusHalf = radiusHalf,
                     .zMin = zMin,
                     .zMax = zMax},
                    brush);
    };
    disc(40, 0, 1, rim);
    disc(37, 1, 6, stone);
    disc(38, 6, 7, rim);
    disc(32, 2, 7, empty);
    disc(32, 1, 2, p.blueGlass.grain(0));
    disc(32, 2, 5, p.water.patches(3, 53));
    canvas.cone({.centerHalf = axis, .bottomRadiusHalf = 9, .topRadiusHalf = 6, .zMin = 1, .zMax = 16},
                stone);
    canvas.cone({.centerHalf = axis, .bottomRadiusHalf = 6, .topRadiusHalf = 20, .zMin = 14, .zMax = 19},
                rim);
    disc(16, 18, 19, p.water.patches(3, 54));
    canvas.cone({.centerHalf = axis, .bottomRadiusHalf = 5, .topRadiusHalf = 4, .zMin = 18, .zMax = 23},
                stone);
    canvas.ball({41, 41, 46}, 6, p.gold.grain(55));
    return canvas;
}

Canvas makeBench(const DemoPalette& p) {
    Canvas canvas({20, 9, 11});
    const Brush slat = [&p](glm::ivec3 v) {
        return p.plank.patches(7, 61u + static_cast<std::uint32_t>(v.y))(v);
    };
    for (const int x : {2, 16}) {
        canvas.box({{x, 1, 0}, {x + 2, 8, 4}}, p.flagstone.grain(62));
        canvas.box({{x, 7, 4}, {x + 2, 9, 11}}, p.wood.grain(63));
    }
    for (const int y : {0, 3, 6}) canvas.box({{0, y, 4}, {20, y + 2, 5}}, slat);
    for (const int z : {7, 9}) canvas.box({{0, 7, z}, {20, 8, z + 1}}, slat);
    return canvas;
}

Canvas makeMetalBall(const DemoPalette& p) {
    Canvas canvas({15, 15, 24});
    canvas.box({{2, 2, 0}, {13, 13, 2}}, p.darkTile.grain(71));
    canvas.box({{3, 3, 2}, {12, 12, 8}}, p.plaster.grain(72));
    canvas.box({{2, 2, 8}, {13, 13, 9}}, p.darkTile.grain(73));
    canvas.ball({15, 15, 33}, 15, p.steel.grain(0));
    return canvas;
}

Canvas makeGlassBlock(const DemoPalette& p) {
    Canvas canvas({12, 12, 20});
    canvas.box({{0, 0, 0}, {12, 12, 2}}, p.darkTile.grain(75));
    canvas.box({{1, 1, 2}, {11, 11, 20}}, p.clearGlass.grain(0));
    canvas.box({{2, 2, 3}, {10, 10, 19}}, empty);
    canvas.ball({12, 12, 20}, 5, p.gold.grain(76));
    return canvas;
}

Canvas makeTable(const DemoPalette& p) {
    Canvas canvas({18, 12, 15});
    for (const int x : {1, 15}) {
        for (const int y : {1, 9}) canvas.box({{x, y, 0}, {x + 2, y + 2, 7}}, p.wood.grain(77));
    }
    canvas.box({{0, 0, 7}, {18, 12, 9}}, p.plank.patches(6, 78));
    canvas.cone({.centerHalf = {10, 12}, .bottomRadiusHalf = 4, .topRadiusHalf = 6, .zMin = 9, .zMax = 13},
                p.blueGlass.grain(0));
    canvas.fillWhere(
        {{2, 3, 12}, {8, 9, 15}}, [](glm::ivec3 v) { return hashOf(v, 79) % 3 != 0; }, p.flowerRed.grain(80));
    canvas.box({{11, 3, 9}, {16, 7, 10}}, p.carpet.grain(81));
    canvas.box({{11, 3, 10}, {16, 7, 11}}, p.flowerRed.grain(82));
    return canvas;
}

}  // namespace pfvox::demo
