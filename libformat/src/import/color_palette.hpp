// ColorPalette: from the colors of a source, at most one material a color, to at most N materials.
//
// Used in two passes over the source: add() every color, finish(), then ask indexOf() for every voxel. The
// outcome depends on the set of colors only, not on their order or number.
#pragma once

#include <cstdint>
#include <pfvox/voxel_model.hpp>
#include <vector>

namespace pfvox::import {

class ColorPalette {
  public:
    /// `maxColors`: 1 to 65536.
    explicit ColorPalette(std::size_t maxColors) : maxColors_(maxColors), present_(kWords, 0) {}

    /// An sRGB color that occurs.
    void add(glm::u8vec3 color) {
        const std::uint32_t code = codeOf(color);
        present_[code >> 6] |= std::uint64_t{1} << (code & 63u);
    }

    /// Fixes the palette. When more than maxColors were added, close colors are joined by median cut
    /// (Heckbert, "Color image quantization for frame buffer display", 1982) on the set of distinct colors;
    /// each group becomes its mean.
    void finish();

    std::size_t distinctColors() const { return distinctColors_; }
    bool quantised() const { return distinctColors_ > maxColors_; }

    /// The palette index of a color that was added. Call after finish().
    MaterialIndex indexOf(glm::u8vec3 color) const;

    /// The palette: sRGB colors by index.
    const std::vector<glm::u8vec3>& colors() const { return colors_; }

  private:
    static constexpr std::size_t kWords = (std::size_t{1} << 24) / 64;

    static std::uint32_t codeOf(glm::u8vec3 c) {
        return (std::uint32_t{c.r} << 16) | (std::uint32_t{c.g} << 8) | std::uint32_t{c.b};
    }
    std::size_t rankOf(std::uint32_t code) const;
    std::vector<std::uint32_t> collect() const;

    std::size_t maxColors_;
    std::size_t distinctColors_ = 0;
    std::vector<std::uint64_t> present_;      ///< one bit for each of the 2^24 colors
    std::vector<std::uint32_t> rankOfWord_;   ///< colors in the words before
    std::vector<MaterialIndex> indexOfRank_;  ///< empty while every color is its own entry
    std::vector<glm::u8vec3> colors_;
};

}  // namespace pfvox::import
