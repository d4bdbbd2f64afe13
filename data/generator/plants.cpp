#include "models.hpp"

namespace pfvox::demo {

namespace {

/// A ball of leaves with a ragged edge and holes that let the light through.
void foliage(Canvas& canvas, glm::ivec3 center, int radius, const Brush& brush, std::uint32_t seed) {
    const Box around{center - radius - 1, center + radius + 2};
    canvas.fillWhere(
        around,
        [&](glm::ivec3 p) {
            const glm::ivec3 d = p - center;
            const int ragged = radius * radius * (160 + patchNoise(p, 4, seed) * 96 / 255) / 256;
            const bool hole = patchNoise(p, 3, seed + 7) < 66;
            return d.x * d.x + d.y * d.y + d.z * d.z * 5 / 4 <= ragged && !hole;
        },
        brush);
}

/// A branch as a row of balls from one point to another, in voxels.
void branch(Canvas& canvas, glm::ivec3 from, glm::ivec3 to, int radiusHalf, const Brush& brush) {
    constexpr int kSteps = 16;
    for (int i = 0; i <= kSteps; ++i) {
        const glm::ivec3 middle = (from * (kSteps - i) + to * i) / kSteps;
        canvas.ball(2 * middle + 1, radiusHalf, brush);
    }
}

void trunk(Canvas& canvas, glm::ivec2 middle, int height, const Brush& brush) {
    canvas.cone(
        {.centerHalf = 2 * middle + 1, .bottomRadiusHalf = 9, .topRadiusHalf = 5, .zMin = 0, .zMax = 4},
        brush);
    canvas.cone(
        {.centerHalf = 2 * middle + 1, .bottomRadiusHalf = 6, .topRadiusHalf = 4, .zMin = 3, .zMax = height},
        brush);
}

}  // namespace

Canvas makeTree(const DemoPalette& p, std::uint32_t seed) {
    Canvas canvas({37, 37, 50});
    const Brush bark = p.bark.patches(3, seed);
    trunk(canvas, {18, 18}, 28, bark);
    const Brush leaves = p.leaf.patches(6, seed + 1);
    for (const glm::ivec3 crown : {glm::ivec3{18, 18, 36}, glm::ivec3{10, 14, 28}, glm::ivec3{27, 16, 30},
                                   glm::ivec3{17, 27, 28}, glm::ivec3{20, 9, 31}}) {
        branch(canvas, {18, 18, 20}, crown, 3, bark);
        foliage(canvas, crown, crown.z > 32 ? 13 : 9, leaves, seed + static_cast<std::uint32_t>(crown.x));
    }
    return canvas;
}

Canvas makeBlossomTree(const DemoPalette& p) {
    Canvas canvas({33, 33, 38});
    const Brush bark = p.bark.patches(3, 91);
    trunk(canvas, {16, 16}, 14, bark);
    const Brush petals = p.blossom.patches(5, 92);
    for (const glm::ivec3 crown : {glm::ivec3{8, 12, 23}, glm::ivec3{24, 13, 24}, glm::ivec3{15, 24, 22},
                                   glm::ivec3{17, 8, 27}, glm::ivec3{16, 17, 29}}) {
        branch(canvas, {16, 16, 11}, crown, 3, bark);
        foliage(canvas, crown, 8, petals, 93 + static_cast<std::uint32_t>(crown.x));
    }
    // Fallen petals.
    canvas.fillWhere(
        {{2, 2, 0}, {31, 31, 1}},
        [&](glm::ivec3 v) {
            const glm::ivec3 d = v - glm::ivec3{16, 16, 0};
            return canvas.at(v) == 0 && d.x * d.x + d.y * d.y < 190 && hashOf(v, 95) % 5 == 0;
        },
        petals);
    return canvas;
}

Canvas makePlanter(const DemoPalette& p) {
    Canvas canvas({20, 8, 12});
    canvas.box({{0, 0, 0}, {20, 8, 5}}, p.terracotta.patches(5, 21));
    canvas.box({{1, 1, 4}, {19, 7, 5}}, p.soil.grain(22));
    canvas.fillWhere(
        {{1, 1, 5}, {19, 7, 9}}, [](glm::ivec3 v) { return patchNoise(v, 3, 23) > 34 * (v.z - 5) + 70; },
        p.leaf.patches(3, 24));
    canvas.fillWhere(
        {{1, 1, 7}, {19, 7, 10}},
        [&](glm::ivec3 v) {
            return canvas.at(v - glm::ivec3{0, 0, 1}) != 0 && hashOf(v, 25) % 4 == 0;
        },
        [&](glm::ivec3 v) {
            const Ramp& flower = v.x < 7 ? p.flowerRed : v.x < 13 ? p.flowerYellow : p.flowerViolet;
            return flower.grain(26)(v);
        });
    return canvas;
}

}  // namespace pfvox::demo
