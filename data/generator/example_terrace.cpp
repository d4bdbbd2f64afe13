#include "models.hpp"

namespace pfvox::demo {

Canvas makeTerrace(const DemoPalette& p) {
    constexpr int kWidth = 64;
    constexpr int kDepth = 48;
    Canvas canvas({kWidth, kDepth, 30});
    const Brush tiles = [&p](glm::ivec3 v) {
        const bool dark = (v.x / 8 + v.y / 8) % 2 == 0;
        return (dark ? p.darkTile : p.lightTile).grain(91)(v);
    };
    canvas.box({{0, 0, 0}, {kWidth, kDepth, 1}}, p.soil.grain(90));
    canvas.box({{0, 0, 1}, {kWidth, kDepth, 2}}, tiles);
    canvas.box({{0, kDepth - 4, 2}, {kWidth, kDepth, 30}}, ashlar(p, 92));
    canvas.box({{0, 0, 2}, {4, kDepth - 4, 26}}, p.redPaint.patches(9, 93));
    canvas.box({{kWidth - 4, 14, 2}, {kWidth, kDepth - 4, 26}}, p.greenPaint.patches(9, 94));
    canvas.box({{kWidth - 4, 22, 8}, {kWidth, 34, 20}}, p.amberGlass.grain(0));
    canvas.box({{22, 8, 1}, {44, 28, 2}}, p.carpetGold.grain(95));
    canvas.box({{23, 9, 1}, {43, 27, 2}}, p.carpet.patches(5, 96));
    return canvas;
}

}  // namespace pfvox::demo
