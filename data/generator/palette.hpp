// Palette: the colors and materials that all demo models share.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "canvas.hpp"

namespace pfvox::demo {

struct Color {
    std::uint8_t r = 0;
    std::uint8_t g = 0;
    std::uint8_t b = 0;
};

/// Neighboring palette entries: the shades of one thing, from dark to light.
struct Ramp {
    int first = 1;
    int count = 1;

    std::uint8_t shade(int i) const { return static_cast<std::uint8_t>(first + std::clamp(i, 0, count - 1)); }
    /// A shade by chance for every voxel.
    Brush grain(std::uint32_t seed) const;
    /// Shades that drift over `scale` voxels, with a little grain.
    Brush patches(int scale, std::uint32_t seed) const;
};

using MaterialText = std::vector<std::pair<std::string, std::string>>;

class Palette {
  public:
    /// `count` shades around `base`, each `contrast` (of 255) lighter than the last.
    Ramp add(Color base, int count, int contrast);
    /// Gives every shade of a ramp the same MATL entries.
    void setMaterial(Ramp ramp, const MaterialText& attributes);

    /// Color of a voxel value; the unused ones are black.
    Color color(int index) const { return colors_[static_cast<std::size_t>(index - 1)]; }
    const std::map<int, MaterialText>& materials() const { return materials_; }

  private:
    std::array<Color, 256> colors_{};
    int next_ = 1;
    std::map<int, MaterialText> materials_;
};

/// Every ramp of the demo scene.
struct DemoPalette {
    DemoPalette();

    Palette palette;
    Ramp sandstone, mortar, flagstone, cobble, plaster, terracotta;
    Ramp redPaint, greenPaint, darkTile, lightTile, carpet, carpetGold;
    Ramp wood, plank, bark, leaf, blossom, grass, soil;
    Ramp flowerRed, flowerYellow, flowerViolet;
    Ramp bronze, gold, steel;
    Ramp water, clearGlass, redGlass, blueGlass, amberGlass;
    Ramp lampLight, ceilingLight;
};

}  // namespace pfvox::demo
