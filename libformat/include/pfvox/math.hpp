// Vectors, boxes and transforms, shared by every stage. GLM does the arithmetic; this header gives the names.
//
// Frame of all pfvox data: right-handed, +Y up, as in glTF. Voxel (x, y, z) of a model fills the unit cube
// from (x, y, z) to (x + 1, y + 1, z + 1).
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>

namespace pfvox {

/// A half-open box of whole voxels: min inclusive, max exclusive. Empty when any max <= min.
struct VoxelBox {
    glm::ivec3 min{std::numeric_limits<int>::max()};  ///< inclusive
    glm::ivec3 max{std::numeric_limits<int>::min()};  ///< exclusive

    bool empty() const {
        return max.x <= min.x || max.y <= min.y || max.z <= min.z;
    }  ///< Whether no voxel is in it.
    /// Edge lengths; 64-bit, because two int32 corners can be farther apart than int32 reaches.
    glm::i64vec3 size() const { return empty() ? glm::i64vec3{0} : glm::i64vec3{max} - glm::i64vec3{min}; }
    void include(const VoxelBox& other) {
        min = glm::min(min, other.min);
        max = glm::max(max, other.max);
    }  ///< Grows to hold the other one, too.
    bool operator==(const VoxelBox&) const = default;
};

/// An affine transform as glm's 4 columns of 3: columns 0..2 the linear part, column 3 the translation.
/// Names say the spaces: worldFromModel * vec4(pModel, 1) = pWorld.
using Affine = glm::dmat4x3;
/// Changes nothing.
inline Affine identityAffine() {
    return Affine{1.0};
}

/// a after b: (aFromB, bFromC) -> aFromC.
inline Affine compose(const Affine& aFromB, const Affine& bFromC) {
    return Affine{glm::dmat4{aFromB} * glm::dmat4{bFromC}};
}

/// Interleaves the low 10 bits of x, y and z: bit 3i of the result is bit i of x, then y, then z. This is the
/// order of octree child slots: slot = x + 2y + 4z.
constexpr std::uint32_t mortonEncode(glm::uvec3 p) {
    constexpr auto spread = [](std::uint32_t v) {
        v &= 0x3ffu;
        v = (v | (v << 16)) & 0x030000ffu;
        v = (v | (v << 8)) & 0x0300f00fu;
        v = (v | (v << 4)) & 0x030c30c3u;
        v = (v | (v << 2)) & 0x09249249u;
        return v;
    };
    return spread(p.x) | (spread(p.y) << 1) | (spread(p.z) << 2);
}

/// Inverse of mortonEncode.
constexpr glm::uvec3 mortonDecode(std::uint32_t code) {
    constexpr auto gather = [](std::uint32_t v) {
        v &= 0x09249249u;
        v = (v | (v >> 2)) & 0x030c30c3u;
        v = (v | (v >> 4)) & 0x0300f00fu;
        v = (v | (v >> 8)) & 0x030000ffu;
        v = (v | (v >> 16)) & 0x3ffu;
        return v;
    };
    return {gather(code), gather(code >> 1), gather(code >> 2)};
}

}  // namespace pfvox
