// LodMeasure: the quantities that a level of detail is made from: visible faces of voxels, shadows of cubes
// along the axes, and histograms of materials.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "octree/opacity_grid.hpp"

namespace pfvox::octree {

/// How many faces (0 to 6) of each voxel of a brick are visible, as three bit planes of a binary number.
class FaceCounts {
  public:
    FaceCounts() = default;
    FaceCounts(const BrickMask& occupied, const OpacityGrid& opacity, CellPlace place);

    /// Sum over the given voxels of one 4^3 block.
    std::uint32_t sum(std::size_t block, std::uint64_t voxels) const;

  private:
    std::array<BrickMask, 3> planes_{};
};

/// Visible faces of a leaf of edge 8 x 2^n that begins at a cell, without looking at its inside.
std::uint32_t facesOfTile(const OpacityGrid& opacity, CellPlace first, std::uint32_t edgeLog2, bool isOpaque);

/// Which columns of a cube along each axis hold a voxel. A word is the shadow of one column of 4^3 blocks, of
/// whose bits 16 are used; words are in 2D Morton order, so that the shadow of an octant is a run of a
/// parent's words.
class Shadow {
  public:
    /// Edge of the cube is 2^edgeLog2, at least 8.
    explicit Shadow(std::uint32_t edgeLog2);

    void clear();
    /// The cube is one brick.
    void set(const BrickMask& brick);
    /// An octant of the cube is solid, or has this shadow.
    void addSolid(std::uint32_t slot);
    void add(std::uint32_t slot, const Shadow& octant);
    /// Columns that are not empty, of all three axes.
    std::uint32_t columns() const;

  private:
    std::span<std::uint64_t> quadrant(unsigned axis, std::uint32_t slot);

    std::array<std::vector<std::uint64_t>, 3> words_;
};

/// The same for the cubes inside a brick: a block of 4^3 and one of its octets.
std::uint32_t shadowColumns(std::uint64_t block);
std::uint32_t shadowColumnsOfOctet(std::uint64_t octet);

/// Visible faces of each palette index.
class Histogram {
  public:
    /// Makes room for a palette; empty afterwards.
    void reset(std::size_t paletteSize) {
        faces_.assign(paletteSize, 0);
        used_.clear();
    }
    void clear() {
        for (const std::uint32_t value : used_) faces_[value] = 0;
        used_.clear();
    }
    void add(std::uint32_t value, std::uint32_t faces) {
        if (faces == 0) return;
        if (faces_[value] == 0) used_.push_back(value);
        faces_[value] += faces;
    }
    void add(const Histogram& other) {
        for (const std::uint32_t value : other.used_) add(value, other.faces_[value]);
    }
    /// Palette indices with any faces, in no order.
    std::span<const std::uint32_t> used() const { return used_; }
    std::uint32_t faces(std::uint32_t value) const { return faces_[value]; }

  private:
    std::vector<std::uint32_t> faces_;
    std::vector<std::uint32_t> used_;
};

}  // namespace pfvox::octree
