// GridColors: a vec3 grid of linear colors as palette materials.
#pragma once

#include <openvdb/Grid.h>
#include <openvdb/openvdb.h>

#include <memory>
#include <pfvox/voxel_model.hpp>
#include <vector>

#include "import/vdb/grid_voxels.hpp"

namespace pfvox::import::vdb {

/// More colors are joined by median cut: a smooth gradient of floats has a different color in every voxel.
inline constexpr std::size_t kMaxGridColors = 4096;

/// The sRGB byte of a linear value; below 0 and not a number is 0, above 1 is 255.
std::uint8_t srgbByteOf(float linear);

struct GridColors {
    std::vector<Material> materials;       ///< the first has index `firstMaterial`
    std::size_t distinctColors = 0;        ///< before joining
    std::uint64_t clampedValues = 0;       ///< voxels and tiles with a component outside of 0 to 1
    std::unique_ptr<const Shader> shader;  ///< shares the tree of the grid
};

/// Float grids of red, green and blue as one vector grid. What is inactive in all of them becomes their
/// backgrounds. Precondition: equal transforms.
openvdb::GridBase::Ptr joinChannels(const openvdb::FloatGrid& red, const openvdb::FloatGrid& green,
                                    const openvdb::FloatGrid& blue);

/// `grid` is a Vec3SGrid or Vec3DGrid.
GridColors makeGridColors(const openvdb::GridBase::ConstPtr& grid, MaterialIndex firstMaterial);

}  // namespace pfvox::import::vdb
