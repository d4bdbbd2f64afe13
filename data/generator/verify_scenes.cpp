#include "verify_scenes.hpp"

namespace pfvox::demo {

namespace {

void put(Canvas& canvas, glm::ivec3 low, glm::ivec3 high, const Brush& brush) {
    canvas.box({low, high}, brush);
}

void putTable(Canvas& canvas, glm::ivec3 corner, glm::ivec2 size, const DemoPalette& p) {
    const Brush legs = p.wood.grain(101);
    for (const int x : {0, size.x - 2}) {
        for (const int y : {0, size.y - 2})
            put(canvas, corner + glm::ivec3{x, y, 0}, corner + glm::ivec3{x + 2, y + 2, 7}, legs);
    }
    put(canvas, corner + glm::ivec3{0, 0, 7}, corner + glm::ivec3{size, 8}, p.plank.patches(6, 102));
}

void putShelf(Canvas& canvas, glm::ivec3 corner, const DemoPalette& p) {
    put(canvas, corner, corner + glm::ivec3{4, 18, 20}, p.wood.grain(103));
    for (const int z : {2, 8, 14}) {
        put(canvas, corner + glm::ivec3{0, 1, z}, corner + glm::ivec3{3, 17, z + 4}, empty);
        put(canvas, corner + glm::ivec3{1, 2, z}, corner + glm::ivec3{3, 9 + z / 2, z + 3},
            p.carpet.grain(104));
    }
}

/// A tub of glowing metal with a rim.
void putCrucible(Canvas& canvas, glm::ivec2 centerHalf, const DemoPalette& p) {
    const auto disc = [&](int radiusHalf, int zMin, int zMax, const Brush& brush) {
        canvas.cone({.centerHalf = centerHalf,
                     .bottomRadiusHalf = radiusHalf,
                     .topRadiusHalf = radiusHalf,
                     .zMin = zMin,
                     .zMax = zMax},
                    brush);
    };
    disc(21, 2, 12, p.bronze.grain(121));
    disc(17, 6, 12, empty);
    disc(17, 6, 10, p.lampLight.grain(0));
}

}  // namespace

Canvas makeInterior(const DemoPalette& p) {
    Canvas canvas({128, 96, 34});
    const Brush plaster = p.plaster.patches(9, 111);
    canvas.box(canvas.all(), plaster);
    put(canvas, {2, 2, 0}, {126, 94, 2}, p.plank.patches(7, 112));
    put(canvas, {2, 2, 2}, {62, 46, 32}, empty);    // living room: sun
    put(canvas, {2, 48, 2}, {62, 94, 32}, empty);   // store: light through its door only
    put(canvas, {64, 2, 2}, {126, 94, 32}, empty);  // hall: windows to the other side, a lamp
    put(canvas, {62, 18, 2}, {64, 28, 24}, empty);  // doors
    put(canvas, {62, 66, 2}, {64, 76, 24}, empty);
    put(canvas, {22, 46, 2}, {32, 48, 24}, empty);
    put(canvas, {14, 0, 12}, {28, 2, 27}, empty);  // windows
    put(canvas, {38, 0, 12}, {52, 2, 27}, empty);
    put(canvas, {126, 40, 12}, {128, 62, 27}, empty);
    put(canvas, {2, 2, 2}, {3, 46, 32}, p.redPaint.grain(113));
    put(canvas, {64, 93, 2}, {126, 94, 32}, p.greenPaint.grain(114));
    put(canvas, {86, 66, 31}, {98, 78, 32}, p.ceilingLight.grain(0));
    putTable(canvas, {24, 18, 2}, {20, 12}, p);
    putTable(canvas, {92, 64, 2}, {14, 20}, p);
    putShelf(canvas, {58, 52, 2}, p);
    putShelf(canvas, {122, 10, 2}, p);
    put(canvas, {6, 76, 2}, {20, 90, 12}, p.sandstone.patches(5, 115));
    put(canvas, {10, 80, 12}, {18, 88, 18}, p.terracotta.grain(116));
    put(canvas, {70, 6, 2}, {96, 14, 6}, p.carpet.patches(6, 117));
    put(canvas, {70, 4, 6}, {96, 7, 11}, p.carpet.patches(6, 118));
    return canvas;
}

Canvas makeFoundry(const DemoPalette& p) {
    Canvas canvas({128, 128, 48});
    canvas.box(canvas.all(), p.cobble.patches(8, 122));
    put(canvas, {2, 2, 2}, {126, 126, 46}, empty);
    put(canvas, {2, 2, 0}, {126, 126, 2}, p.flagstone.patches(8, 123));
    putCrucible(canvas, {64, 64}, p);
    putCrucible(canvas, {190, 90}, p);
    put(canvas, {60, 92, 2}, {100, 96, 4}, p.lampLight.grain(0));  // a runner of glowing metal
    put(canvas, {58, 91, 2}, {102, 92, 5}, p.bronze.grain(124));
    put(canvas, {58, 96, 2}, {102, 97, 5}, p.bronze.grain(125));
    for (const int x : {30, 62, 94}) {
        for (const int y : {60, 62})
            canvas.cone({.centerHalf = {2 * x, 2 * y - 2},
                         .bottomRadiusHalf = 9,
                         .topRadiusHalf = 9,
                         .zMin = 2,
                         .zMax = 46},
                        p.steel.grain(0));
    }
    put(canvas, {2, 58, 30}, {126, 64, 34}, p.bronze.patches(6, 126));  // a gallery across the hall
    put(canvas, {8, 100, 2}, {26, 118, 14}, p.gold.grain(127));
    put(canvas, {104, 104, 2}, {118, 118, 10}, p.terracotta.patches(5, 128));
    put(canvas, {70, 10, 2}, {71, 40, 22}, p.steel.grain(0));  // a screen of steel
    put(canvas, {100, 40, 44}, {116, 80, 48}, empty);          // a skylight
    return canvas;
}

}  // namespace pfvox::demo
