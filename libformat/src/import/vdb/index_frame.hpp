// IndexFrame: how the index space of a grid is turned into the voxels of a model.
#pragma once

#include <openvdb/math/Coord.h>

#include <array>
#include <pfvox/import.hpp>

namespace pfvox::import::vdb {

/// From index space to the voxels of the model: nothing, or a quarter turn that puts +z up.
class IndexFrame {
  public:
    explicit IndexFrame(UpAxis up) : up_(up) {
        for (std::uint32_t offset = 0; offset < kBrickVoxels; ++offset) {
            const glm::uvec3 local{offset >> 6, (offset >> 3) & 7u, offset & 7u};
            morton_[offset] = static_cast<std::uint16_t>(
                mortonEncode(up == UpAxis::Y ? local : glm::uvec3{local.x, local.z, 7u - local.y}));
        }
    }

    /// Lower corner of the cube that begins at `corner` in index space.
    glm::ivec3 cube(const openvdb::Coord& corner, int edgeLog2) const {
        if (up_ == UpAxis::Y) return {corner.x(), corner.y(), corner.z()};
        const std::int64_t turned = -std::int64_t{corner.y()} - (std::int64_t{1} << edgeLog2);
        return {corner.x(), corner.z(), static_cast<int>(turned)};
    }

    /// Place in a brick of a voxel, by its offset in the leaf node.
    std::uint16_t mortonOf(std::uint32_t offset) const { return morton_[offset]; }

  private:
    UpAxis up_;
    std::array<std::uint16_t, kBrickVoxels> morton_{};
};

}  // namespace pfvox::import::vdb
