// GridTransform: the 48 ways to turn and mirror a grid onto itself, and grid transforms made of one and a
// translation.
#pragma once

#include <array>
#include <cstdint>
#include <pfvox/math.hpp>

namespace pfvox::import {

/// A signed permutation matrix: row r has its only nonzero entry, sign[r], in column[r].
struct Rotation {
    std::array<std::uint8_t, 3> column{0, 1, 2};
    std::array<std::int8_t, 3> sign{1, 1, 1};

    glm::i64vec3 operator*(glm::i64vec3 p) const;
    /// The product of matrices: first b, then *this.
    Rotation operator*(const Rotation& b) const;
    Rotation inverse() const;
    bool operator==(const Rotation&) const = default;
};

/// From one grid to another, in whole voxels; maps points, not cells: p -> rotation * p + translation.
struct GridTransform {
    Rotation rotation;
    glm::i64vec3 translation{0};

    glm::i64vec3 apply(glm::i64vec3 point) const { return rotation * point + translation; }
    /// The minimum corner of the image of the unit cube at `cell`, which is the cell that it becomes.
    glm::i64vec3 applyToCell(glm::i64vec3 cell) const;
    /// First b, then *this.
    GridTransform operator*(const GridTransform& b) const;
    GridTransform inverse() const;
    /// The same as an affine transform, scaled afterwards.
    Affine toAffine(double scale) const;
};

}  // namespace pfvox::import
