// Rotation: the 48 ways to turn and mirror a grid onto itself, and grid transforms made of one and a
// translation.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <pfvox/math.hpp>

namespace pfvox::import::vox {

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

/// Decodes the byte that VOX files keep as `_r`: bits 0-1 the column of row 0, bits 2-3 that of row 1, bits
/// 4, 5 and 6 the signs of the rows, 1 meaning negative. Nothing unless the columns differ and are below 3
/// (48 of 128 values).
std::optional<Rotation> decodeRotation(std::int32_t byte);

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

}  // namespace pfvox::import::vox
