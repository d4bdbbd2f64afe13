#include "palette.hpp"

namespace pfvox::demo {

Brush Ramp::grain(std::uint32_t seed) const {
    return [ramp = *this, seed](glm::ivec3 p) {
        return ramp.shade(static_cast<int>(hashOf(p, seed) % static_cast<std::uint32_t>(ramp.count)));
    };
}

Brush Ramp::patches(int scale, std::uint32_t seed) const {
    return [ramp = *this, scale, seed](glm::ivec3 p) {
        const int drift = patchNoise(p, scale, seed) * ramp.count / 256;
        const std::uint32_t chance = hashOf(p, seed + 1) % 8;
        const int grain = chance == 0 ? -1 : chance == 1 ? 1 : 0;
        return ramp.shade(drift + grain);
    };
}

Ramp Palette::add(Color base, int count, int contrast) {
    const Ramp ramp{.first = next_, .count = count};
    for (int i = 0; i < count; ++i) {
        const int lift = contrast * (2 * i - count + 1) / 2;
        const auto channel = [&](std::uint8_t v) {
            return static_cast<std::uint8_t>(std::clamp(v + lift * (64 + v) / 255, 0, 255));
        };
        colors_[static_cast<std::size_t>(next_ - 1)] = {channel(base.r), channel(base.g), channel(base.b)};
        ++next_;
    }
    return ramp;
}

void Palette::setMaterial(Ramp ramp, const MaterialText& attributes) {
    for (int i = 0; i < ramp.count; ++i) materials_[ramp.first + i] = attributes;
}

namespace {

MaterialText metal(const char* roughness) {
    return {{"_type", "_metal"}, {"_metal", "0.9"}, {"_rough", roughness}, {"_sp", "1"}};
}

MaterialText glass(const char* transparency, const char* indexOfRefractionMinusOne) {
    return {{"_type", "_glass"},
            {"_rough", "0.05"},
            {"_ior", indexOfRefractionMinusOne},
            {"_trans", transparency},
            {"_alpha", transparency}};
}

MaterialText emission(const char* amount, const char* powerOfTen) {
    return {{"_type", "_emit"}, {"_emit", amount}, {"_flux", powerOfTen}};
}

}  // namespace

DemoPalette::DemoPalette()
    : sandstone(palette.add({201, 176, 138}, 6, 12)),
      mortar(palette.add({168, 146, 116}, 2, 10)),
      flagstone(palette.add({158, 151, 142}, 6, 11)),
      cobble(palette.add({112, 108, 108}, 5, 11)),
      plaster(palette.add({228, 222, 208}, 4, 7)),
      terracotta(palette.add({178, 84, 54}, 6, 14)),
      redPaint(palette.add({186, 36, 30}, 3, 8)),
      greenPaint(palette.add({40, 142, 52}, 3, 8)),
      darkTile(palette.add({74, 66, 64}, 3, 8)),
      lightTile(palette.add({214, 202, 182}, 3, 8)),
      carpet(palette.add({38, 58, 122}, 3, 10)),
      carpetGold(palette.add({202, 160, 62}, 2, 10)),
      wood(palette.add({104, 68, 40}, 5, 12)),
      plank(palette.add({150, 104, 62}, 5, 11)),
      bark(palette.add({88, 66, 48}, 4, 13)),
      leaf(palette.add({72, 122, 46}, 6, 15)),
      blossom(palette.add({232, 158, 178}, 6, 13)),
      grass(palette.add({96, 136, 54}, 6, 11)),
      soil(palette.add({92, 70, 50}, 4, 10)),
      flowerRed(palette.add({206, 52, 48}, 2, 16)),
      flowerYellow(palette.add({238, 200, 66}, 2, 14)),
      flowerViolet(palette.add({132, 84, 176}, 2, 16)),
      bronze(palette.add({164, 112, 62}, 3, 12)),
      gold(palette.add({244, 196, 88}, 2, 8)),
      steel(palette.add({206, 208, 212}, 1, 0)),
      water(palette.add({104, 176, 190}, 2, 10)),
      clearGlass(palette.add({212, 232, 234}, 1, 0)),
      redGlass(palette.add({214, 50, 56}, 1, 0)),
      blueGlass(palette.add({54, 94, 206}, 1, 0)),
      amberGlass(palette.add({244, 178, 54}, 1, 0)),
      lampLight(palette.add({255, 196, 112}, 1, 0)),
      ceilingLight(palette.add({255, 238, 210}, 1, 0)) {
    palette.setMaterial(bronze, metal("0.35"));
    palette.setMaterial(gold, metal("0.15"));
    palette.setMaterial(steel, metal("0.02"));
    palette.setMaterial(water, glass("0.6", "0.33"));
    for (const Ramp& pane : {clearGlass, redGlass, blueGlass, amberGlass}) {
        palette.setMaterial(pane, glass("0.8", "0.5"));
    }
    palette.setMaterial(lampLight, emission("0.8", "1"));
    palette.setMaterial(ceilingLight, emission("1", "1"));
}

}  // namespace pfvox::demo
