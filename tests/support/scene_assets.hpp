// Octree assets and PF_VOX files for tests of scenes: boxes whose place can be computed by hand.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <pfvox/files.hpp>
#include <pfvox/pf_vox.hpp>

#include "support/voxel_models.hpp"

namespace pfvox::test {

/// From voxels of a model to the metres of its file: moved by whole voxels.
inline Affine metresFromVoxels(double voxelSizeMetres, const glm::dvec3& offsetVoxels) {
    Affine m{voxelSizeMetres};
    m[3] = voxelSizeMetres * offsetVoxels;
    return m;
}

/// One solid box, placed once for each offset (in voxels).
inline OctreeAsset boxAsset(const VoxelBox& box, double voxelSizeMetres,
                            const std::vector<glm::dvec3>& offsetsVoxels = {glm::dvec3(0.0)}) {
    VoxelAsset asset;
    asset.materials = {{.baseColor = {200, 40, 30, 255}, .name = "brick"}};
    asset.source = {.format = "test", .voxelSizeMetres = voxelSizeMetres, .notes = {}};
    asset.models.push_back(boxModel(box.min, box.max, 0));
    for (const glm::dvec3& offset : offsetsVoxels) {
        asset.instances.push_back({.model = 0, .worldFromModel = metresFromVoxels(voxelSizeMetres, offset)});
    }
    return buildOctrees(asset, Limits{}).value();
}

inline void writePfVox(const std::filesystem::path& file, const OctreeAsset& asset) {
    const auto bytes = encodePfVox(asset, {});
    ASSERT_TRUE(bytes) << describe(bytes.error());
    ASSERT_TRUE(io::writeFileAtomically(file, *bytes));
}

}  // namespace pfvox::test
