// Canvas: a block of voxels to draw on with simple solids and brushes. z is up.
//
// Whole numbers only: the committed bytes must come out the same with every compiler and processor.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <vector>

namespace pfvox::demo {

/// What is put at a position: a palette index, 0 = nothing.
using Brush = std::function<std::uint8_t(glm::ivec3)>;

/// Half open: from min up to, not including, max.
struct Box {
    glm::ivec3 min;
    glm::ivec3 max;
};

/// A well mixed 32-bit number for a position; the only source of chance here.
std::uint32_t hashOf(glm::ivec3 p, std::uint32_t seed);

/// Smooth noise in [0, 255] with features of about `scale` voxels.
int patchNoise(glm::ivec3 p, int scale, std::uint32_t seed);

class Canvas {
  public:
    explicit Canvas(glm::ivec3 size)
        : size_(size),
          cells_(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) *
                 static_cast<std::size_t>(size.z)) {}

    glm::ivec3 size() const { return size_; }
    Box all() const { return {glm::ivec3{0}, size_}; }

    /// 0 outside.
    std::uint8_t at(glm::ivec3 p) const { return contains(p) ? cells_[indexOf(p)] : std::uint8_t{0}; }
    /// Does nothing outside.
    void set(glm::ivec3 p, std::uint8_t index) {
        if (contains(p)) cells_[indexOf(p)] = index;
    }

    void box(Box box, const Brush& brush);
    /// Every voxel of the box for which `inside` holds.
    void fillWhere(Box box, const std::function<bool(glm::ivec3)>& inside, const Brush& brush);

    /// Solids around a center. Centers and radii count half voxels, so that even sizes can be symmetric:
    /// voxel p has its middle at 2p + 1.
    void ball(glm::ivec3 centerHalf, int radiusHalf, const Brush& brush);
    /// Upright, from zMin up to, not including, zMax; the radius changes evenly from bottom to top.
    struct Cone {
        glm::ivec2 centerHalf;
        int bottomRadiusHalf;
        int topRadiusHalf;
        int zMin;
        int zMax;
    };
    void cone(const Cone& cone, const Brush& brush);
    /// A ring around the given axis (0 = x, 1 = y, 2 = z).
    void torus(glm::ivec3 centerHalf, glm::ivec2 radiiHalf, int axis, const Brush& brush);

  private:
    bool contains(glm::ivec3 p) const {
        return p.x >= 0 && p.y >= 0 && p.z >= 0 && p.x < size_.x && p.y < size_.y && p.z < size_.z;
    }
    std::size_t indexOf(glm::ivec3 p) const {
        return (static_cast<std::size_t>(p.z) * static_cast<std::size_t>(size_.y) +
                static_cast<std::size_t>(p.y)) *
                   static_cast<std::size_t>(size_.x) +
               static_cast<std::size_t>(p.x);
    }

    glm::ivec3 size_;
    std::vector<std::uint8_t> cells_;
};

/// Nothing: carves.
inline std::uint8_t empty(glm::ivec3) {
    return 0;
}

}  // namespace pfvox::demo
