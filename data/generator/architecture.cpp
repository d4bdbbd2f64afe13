#include "models.hpp"

namespace pfvox::demo {

Brush ashlar(const DemoPalette& p, std::uint32_t seed) {
    return [&p, seed](glm::ivec3 v) -> std::uint8_t {
        const int course = v.z / 4;
        const int along = v.x + v.y + (course % 2) * 4;
        if (v.z % 4 == 3 || along % 8 == 7) return p.mortar.grain(seed)(v);
        // One drift for a stone, grain for its voxels.
        const glm::ivec3 stone{along / 8, course, 0};
        const int tone = static_cast<int>(hashOf(stone, seed + 1) % 4u);
        const int grain = static_cast<int>(hashOf(v, seed + 2) % 3u);
        return p.sandstone.shade(tone + grain);
    };
}

namespace {

constexpr int kGroundEdge = 126;
constexpr int kGroundHeight = 4;

bool isPath(glm::ivec2 fromMiddle) {
    const glm::ivec2 a = glm::abs(fromMiddle);
    return a.x < 9 || a.y < 8;
}

/// Flower beds along the paths.
bool isBed(glm::ivec2 fromMiddle) {
    const glm::ivec2 a = glm::abs(fromMiddle);
    return (a.x >= 10 && a.x < 14 && a.y >= 26) || (a.y >= 9 && a.y < 12 && a.x >= 28);
}

std::uint8_t pathStone(const DemoPalette& p, glm::ivec3 v) {
    const glm::ivec2 tile{v.x / 6, (v.y + (v.x / 6 % 2) * 3) / 6};
    const bool joint = v.x % 6 == 0 || (v.y + (v.x / 6 % 2) * 3) % 6 == 0;
    if (joint) return p.cobble.grain(3)(v);
    return p.flagstone.shade(static_cast<int>(hashOf({tile, 0}, 4) % 4u) +
                             static_cast<int>(hashOf(v, 5) % 2u));
}

/// Rings of cobble and light stone about the fountain.
std::uint8_t plazaStone(const DemoPalette& p, glm::ivec3 v, int squared) {
    int ring = 0;
    while ((ring + 1) * (ring + 1) * 16 <= squared) ++ring;
    return ring % 2 == 0 ? p.cobble.grain(6)(v) : p.sandstone.patches(5, 7)(v);
}

std::uint8_t groundTop(const DemoPalette& p, glm::ivec3 v) {
    const glm::ivec2 d = glm::ivec2{v} - glm::ivec2{kGroundEdge / 2, 52};
    const int squared = d.x * d.x + d.y * d.y;
    if (squared < 34 * 34) return plazaStone(p, v, squared);
    const bool underArcade = v.x < 15 || v.x >= kGroundEdge - 15 || v.y >= 80;
    if (underArcade || isPath(d)) return pathStone(p, v);
    if (isBed(d)) return p.soil.grain(8)(v);
    return p.grass.patches(9, 9)(v);
}

}  // namespace

Canvas makeGround(const DemoPalette& p) {
    Canvas canvas({kGroundEdge, kGroundEdge, kGroundHeight + 3});
    const int top = kGroundHeight - 1;
    canvas.box({{0, 0, 0}, {kGroundEdge, kGroundEdge, top}}, p.soil.patches(8, 10));
    canvas.box({{1, 1, 0}, {kGroundEdge - 1, kGroundEdge - 1, top}}, empty);  // never seen
    canvas.box({{0, 0, top}, {kGroundEdge, kGroundEdge, top + 1}},
               [&](glm::ivec3 v) { return groundTop(p, v); });
    // Blades of grass, and flowers in the beds.
    canvas.fillWhere(
        {{0, 0, top + 1}, {kGroundEdge, kGroundEdge, top + 4}},
        [&](glm::ivec3 v) {
            const std::uint8_t below = canvas.at({v.x, v.y, top});
            const bool onGrass = below >= p.grass.shade(0) && below <= p.grass.shade(p.grass.count);
            const bool onSoil = below >= p.soil.shade(0) && below <= p.soil.shade(p.soil.count);
            const int height = static_cast<int>(hashOf({v.x, v.y, 0}, 11) % 100u);
            if (onGrass) return v.z == top + 1 && height < 14;
            return onSoil && v.z - top <= (height < 25 ? 3 : height < 70 ? 2 : 1);
        },
        [&](glm::ivec3 v) {
            const std::uint32_t chance = hashOf({v.x, v.y, 0}, 12) % 7u;
            if (v.z < top + 2 || chance > 4) return p.grass.patches(4, 13)(v);
            const Ramp& flower = patchNoise({v.x, v.y, 0}, 9, 14) < 110 ? p.flowerRed
                                 : chance < 2                           ? p.flowerYellow
                                                                        : p.flowerViolet;
            return flower.grain(15)(v);
        });
    return canvas;
}

Canvas makeArch(const DemoPalette& p) {
    constexpr int kWidth = 24;
    constexpr int kDepth = 14;
    Canvas canvas({kWidth, kDepth, 42});
    const Brush stone = ashlar(p, 101);
    // Front and back wall; the opening looks towards y = 0.
    canvas.box({{0, 1, 0}, {kWidth, 4, 30}}, stone);
    canvas.box({{0, kDepth - 2, 0}, {kWidth, kDepth, 30}}, p.plaster.patches(7, 102));
    canvas.box({{4, 1, 0}, {kWidth - 4, 4, 17}}, empty);
    canvas.fillWhere(
        {{4, 1, 17}, {kWidth - 4, 4, 28}},
        [](glm::ivec3 v) {
            const int x = 2 * v.x + 1 - kWidth;
            const int z = 2 * (v.z - 17) + 1;
            return x * x + z * z <= 16 * 16;
        },
        empty);
    // Piers with a foot and a capital.
    for (const int x : {0, kWidth - 4}) {
        canvas.box({{x, 0, 0}, {x + 4, 5, 3}}, p.flagstone.patches(4, 103));
        canvas.box({{x, 0, 15}, {x + 4, 5, 17}}, p.flagstone.patches(4, 104));
    }
    canvas.box({{0, 0, 30}, {kWidth, kDepth, 31}}, p.wood.patches(6, 105));
    // A lean-to roof of tiles, falling towards the court.
    canvas.fillWhere(
        {{0, 0, 31}, {kWidth, kDepth, 42}},
        [](glm::ivec3 v) { return v.z - 31 <= (v.y * 3) / 5 + (v.x % 4 == 0 ? 1 : 0); },
        [&](glm::ivec3 v) {
            return p.terracotta.shade(static_cast<int>(hashOf({v.x / 4, v.y / 3, 0}, 106) % 4u) +
                                      static_cast<int>(hashOf(v, 107) % 2u));
        });
    return canvas;
}

Canvas makeStairs(const DemoPalette& p) {
    constexpr int kWidth = 14;
    constexpr int kRun = kHouseHeight + 2;
    Canvas canvas({kWidth, kRun, kHouseHeight + 8});
    const Brush side = ashlar(p, 111);
    const Brush step = p.flagstone.patches(5, 112);
    for (int y = 0; y < kRun; ++y) {
        const int height = std::min((y / 2 + 1) * 2, kHouseHeight);  // steps of 2 voxels
        canvas.box({{0, y, 0}, {kWidth, y + 1, height - 1}}, side);
        canvas.box({{0, y, height - 1}, {kWidth, y + 1, height}}, step);
        for (const int x : {0, kWidth - 1}) canvas.box({{x, y, height}, {x + 1, y + 1, height + 6}}, side);
        for (const int x : {0, kWidth - 1})
            canvas.box({{x, y, height + 6}, {x + 1, y + 1, height + 7}}, step);
    }
    canvas.box({{0, kRun - 10, kHouseHeight}, {1, kRun, kHouseHeight + 8}}, empty);  // the way onto the roof
    return canvas;
}

Canvas makeTower(const DemoPalette& p) {
    Canvas canvas({34, 34, 112});
    const glm::ivec2 axis{34, 34};
    const auto drum = [&](int bottom, int top, int zMin, int zMax, const Brush& brush) {
        canvas.cone({.centerHalf = axis,
                     .bottomRadiusHalf = bottom,
                     .topRadiusHalf = top,
                     .zMin = zMin,
                     .zMax = zMax},
                    brush);
    };
    drum(31, 28, 0, 6, p.flagstone.patches(5, 121));
    drum(28, 26, 6, 70, ashlar(p, 122));
    drum(32, 32, 68, 72, p.flagstone.patches(5, 123));
    drum(22, 21, 1, 68, empty);
    drum(22, 22, 68, 69, p.plank.patches(5, 124));
    // Slit windows with lit panes inside, one turn of a stair apart.
    for (const int z : {18, 36, 54}) {
        canvas.box({{15, 0, z}, {19, 7, z + 9}}, empty);
        canvas.box({{15, 4, z}, {19, 5, z + 9}}, p.amberGlass.grain(0));
        canvas.box({{27, 15, z + 6}, {34, 19, z + 15}}, empty);
        canvas.box({{29, 15, z + 6}, {30, 19, z + 15}}, p.amberGlass.grain(0));
    }
    drum(34, 1, 72, 106, [&](glm::ivec3 v) {
        const int row = v.z / 3;
        return p.terracotta.shade(static_cast<int>(hashOf({(v.x + row) / 3, v.y / 3, row}, 125) % 4u) +
                                  static_cast<int>(hashOf(v, 126) % 3u));
    });
    canvas.box({{16, 16, 104}, {18, 18, 108}}, p.bronze.grain(127));
    canvas.ball({34, 34, 217}, 6, p.gold.grain(128));
    return canvas;
}

}  // namespace pfvox::demo
