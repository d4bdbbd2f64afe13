// The house: one room with a red and a green side wall, so that reflected light shows, and a roof terrace.

#include "models.hpp"

namespace pfvox::demo {

namespace {

constexpr glm::ivec3 kSize{68, 44, kHouseHeight + 6};
constexpr int kWall = 4;
constexpr Box kRoom{{kWall, kWall, 1}, {kSize.x - kWall, kSize.y - kWall, kHouseHeight - 3}};

void buildShell(Canvas& canvas, const DemoPalette& p) {
    canvas.box({{0, 0, 0}, {kSize.x, kSize.y, kHouseHeight}}, ashlar(p, 201));
    canvas.box({{0, 0, 0}, {kSize.x, kSize.y, 1}}, p.flagstone.patches(5, 202));
    canvas.box(kRoom, empty);
    canvas.box({{0, 0, kHouseHeight - 3}, {kSize.x, kSize.y, kHouseHeight - 1}}, p.wood.patches(6, 203));
    canvas.box({{0, 0, kHouseHeight - 1}, {kSize.x, kSize.y, kHouseHeight}}, [&](glm::ivec3 v) {
        const bool light = (v.x / 4 + v.y / 4) % 2 == 0;
        return light ? p.terracotta.grain(204)(v) : p.flagstone.grain(205)(v);
    });
}

void paintRoom(Canvas& canvas, const DemoPalette& p) {
    const auto [low, high] = kRoom;
    canvas.box({{low.x - 1, low.y, 1}, {low.x, high.y, high.z}}, p.redPaint.grain(211));
    canvas.box({{high.x, low.y, 1}, {high.x + 1, high.y, high.z}}, p.greenPaint.grain(212));
    canvas.box({{low.x - 1, high.y, 1}, {high.x + 1, high.y + 1, high.z}}, p.plaster.grain(213));
    canvas.box({{low.x - 1, low.y - 1, 1}, {high.x + 1, low.y, high.z}}, p.plaster.grain(214));
    canvas.box({{low.x, low.y, high.z}, {high.x, high.y, high.z + 1}}, p.plaster.grain(215));
    canvas.box({{low.x, low.y, 0}, {high.x, high.y, 1}}, [&](glm::ivec3 v) {
        return (v.x / 5 + v.y / 5) % 2 == 0 ? p.darkTile.grain(216)(v) : p.lightTile.grain(217)(v);
    });
    // A carpet with a golden border.
    canvas.box({{22, 10, 1}, {46, 30, 2}}, [&](glm::ivec3 v) {
        const bool border = v.x < 24 || v.x >= 44 || v.y < 12 || v.y >= 28;
        return border ? p.carpetGold.grain(218)(v) : p.carpet.patches(4, 219)(v);
    });
    canvas.box({{24, 14, high.z}, {44, 28, high.z + 1}}, p.ceilingLight.grain(0));
    for (const int x : {low.x + 12, high.x - 14}) {  // beams
        canvas.box({{x, low.y, high.z - 3}, {x + 2, high.y, high.z}}, p.wood.patches(5, 220));
    }
}

/// An opening with a round top in a wall along x, `brush` inside.
struct Opening {
    int middleHalf;  ///< in half voxels
    int radius;
    int zMin;
    int zSpring;  ///< where the round part begins
};
void cutOpening(Canvas& canvas, const Opening& opening, int yMin, int yMax, const Brush& brush) {
    const int left = opening.middleHalf / 2 - opening.radius;
    canvas.fillWhere(
        {{left, yMin, opening.zMin}, {left + 2 * opening.radius, yMax, opening.zSpring + opening.radius}},
        [&](glm::ivec3 v) {
            if (v.z < opening.zSpring) return true;
            const int x = 2 * v.x + 1 - opening.middleHalf;
            const int z = 2 * (v.z - opening.zSpring) + 1;
            return x * x + z * z <= 4 * opening.radius * opening.radius;
        },
        brush);
}

void cutFront(Canvas& canvas, const DemoPalette& p) {
    const Opening portal{.middleHalf = kSize.x, .radius = 13, .zMin = 1, .zSpring = 19};
    const Opening frame{.middleHalf = kSize.x, .radius = 15, .zMin = 1, .zSpring = 19};
    cutOpening(canvas, frame, 0, 1, p.flagstone.patches(4, 221));
    cutOpening(canvas, portal, 0, kWall, empty);
    for (const int middleHalf : {22, 2 * kSize.x - 22}) {
        const Opening window{.middleHalf = middleHalf, .radius = 4, .zMin = 12, .zSpring = 24};
        const Opening windowFrame{.middleHalf = middleHalf, .radius = 6, .zMin = 10, .zSpring = 24};
        cutOpening(canvas, windowFrame, 0, 1, p.flagstone.patches(4, 222));
        cutOpening(canvas, window, 0, kWall, empty);
        cutOpening(canvas, window, 2, 3, p.clearGlass.grain(0));
        canvas.box({{middleHalf / 2 - 4, 2, 19}, {middleHalf / 2 + 4, 3, 20}}, p.wood.grain(223));
    }
}

/// A round window of colored glass in the back wall.
void cutRose(Canvas& canvas, const DemoPalette& p) {
    const glm::ivec2 middleHalf{kSize.x, 48};
    const auto squared = [&](glm::ivec3 v) {
        const glm::ivec2 d = 2 * glm::ivec2{v.x, v.z} + 1 - middleHalf;
        return d.x * d.x + d.y * d.y;
    };
    const Box wall{{0, kSize.y - kWall, 0}, {kSize.x, kSize.y, kHouseHeight}};
    canvas.fillWhere(
        wall, [&](glm::ivec3 v) { return squared(v) <= 23 * 23; }, p.flagstone.grain(231));
    canvas.fillWhere(
        wall, [&](glm::ivec3 v) { return squared(v) <= 20 * 20; }, empty);
    const Box pane{{0, kSize.y - 3, 0}, {kSize.x, kSize.y - 2, kHouseHeight}};
    canvas.fillWhere(
        pane, [&](glm::ivec3 v) { return squared(v) <= 20 * 20; },
        [&](glm::ivec3 v) {
            const glm::ivec2 d = 2 * glm::ivec2{v.x, v.z} + 1 - middleHalf;
            const glm::ivec2 a = glm::abs(d);
            const int r = squared(v);
            const bool lead = a.x <= 1 || a.y <= 1 || (a.x - a.y) * (a.x - a.y) <= 2 || (r > 100 && r < 150);
            if (lead) return p.darkTile.shade(0);
            if (r < 100) return p.amberGlass.shade(0);
            return (d.x > 0) == (d.y > 0) ? p.redGlass.shade(0) : p.blueGlass.shade(0);
        });
}

void buildParapet(Canvas& canvas, const DemoPalette& p) {
    const int z = kHouseHeight;
    canvas.fillWhere(
        {{0, 0, z}, {kSize.x, kSize.y, z + 6}},
        [&](glm::ivec3 v) {
            const bool edge = v.x < 2 || v.y < 2 || v.x >= kSize.x - 2 || v.y >= kSize.y - 2;
            const bool merlon = (v.x + v.y) / 4 % 2 == 0;
            const bool gate = v.x >= kSize.x - 2 && v.y >= 26 && v.y < 40;  // where the stairs arrive
            return edge && !gate && (v.z < z + 3 || merlon);
        },
        ashlar(p, 241));
}

}  // namespace

Canvas makeHouse(const DemoPalette& p) {
    Canvas canvas(kSize);
    buildShell(canvas, p);
    paintRoom(canvas, p);
    cutFront(canvas, p);
    cutRose(canvas, p);
    buildParapet(canvas, p);
    return canvas;
}

}  // namespace pfvox::demo
