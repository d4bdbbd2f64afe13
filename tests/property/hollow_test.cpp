// Hollowing: what can be seen stays, what cannot be seen merges. The oracle asks for every voxel and its
// neighbors.
#include <pfvox/hollow.hpp>

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <pfvox/pf_vox.hpp>

#include "support/voxel_models.hpp"

namespace pfvox {
namespace {

constexpr glm::ivec3 kSteps[6] = {{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}};

VoxelAsset assetOf(VoxelModel model) {
    std::vector<VoxelModel> models;
    models.push_back(std::move(model));
    return test::assetOf(std::move(models));
}

/// Materials that differ in every voxel, with a bubble of glass: across the borders of bricks and regions.
VoxelModel noisyBall(glm::ivec3 center, int radius) {
    std::mt19937 random(3);
    VoxelModel model;
    for (int z = -radius; z <= radius; ++z)
        for (int y = -radius; y <= radius; ++y)
            for (int x = -radius; x <= radius; ++x) {
                if (x * x + y * y + z * z > radius * radius) continue;
                const bool bubble = (x - 4) * (x - 4) + y * y + z * z < 9;
                model.set(center + glm::ivec3{x, y, z},
                          static_cast<MaterialIndex>(bubble ? 3 : random() % 3));
            }
    return model;
}

bool isOpaqueAt(const VoxelModel& model, const VoxelAsset& asset, glm::ivec3 p) {
    const auto material = model.at(p);
    return material && isOpaque(asset.materials[*material]);
}

/// Compares the hollowed asset with what went in; returns the number of hidden voxels.
std::uint64_t expectOnlyHiddenChanged(const VoxelModel& before, const VoxelAsset& after,
                                      const VoxelBox& box) {
    std::uint64_t hidden = 0;
    for (const test::Voxel& v : test::voxelsIn(before, box)) {
        const auto now = after.models[0].at(v.position);
        EXPECT_TRUE(now) << "no voxel vanishes";
        if (!now) return hidden;
        bool covered = isOpaqueAt(before, after, v.position);
        for (const glm::ivec3 step : kSteps)
            covered = covered && isOpaqueAt(before, after, v.position + step);
        if (covered) {
            ++hidden;
            EXPECT_TRUE(isOpaque(after.materials[*now])) << "solids stay solid";
        } else {
            EXPECT_EQ(*now, v.material) << v.position.x << ' ' << v.position.y << ' ' << v.position.z;
        }
    }
    return hidden;
}

std::uint64_t leavesOf(const VoxelAsset& asset) {
    const OctreeAsset built = buildOctrees(asset, Limits{}).value();
    return statistics(built.models[0], built.materials.size()).leaves;
}

TEST(Hollow, VisibleVoxelsOfEveryModelKeepTheirMaterial) {
    for (const test::NamedModel& named : test::standardModels()) {
        if (named.name == "far apart" || named.name == "tiles") continue;  // too large to ask for every voxel
        SCOPED_TRACE(named.name);
        const VoxelBox box = named.model.bounds();
        const VoxelModel before = test::copyOf(named.model, box);
        VoxelAsset asset = assetOf(test::copyOf(named.model, box));
        const HollowReport report = hollowSolids(asset);
        EXPECT_TRUE(asset.hollowed);
        EXPECT_EQ(report.hiddenVoxels, expectOnlyHiddenChanged(before, asset, box));
        EXPECT_EQ(asset.models[0].voxelCount(), before.voxelCount());
    }
}

TEST(Hollow, NoisyBallNeedsFewerLeavesAcrossRegions) {
    const glm::ivec3 center{250, 3, -5};
    const VoxelModel before = noisyBall(center, 20);
    VoxelAsset asset = assetOf(noisyBall(center, 20));
    const std::uint64_t leavesBefore = leavesOf(asset);
    const HollowReport report = hollowSolids(asset);
    EXPECT_EQ(report.hiddenVoxels, expectOnlyHiddenChanged(before, asset, before.bounds()));
    EXPECT_GT(report.changedVoxels, report.hiddenVoxels / 2);
    EXPECT_LT(leavesOf(asset), leavesBefore / 3);

    EXPECT_EQ(hollowSolids(asset).changedVoxels, 0u) << "twice is as once";
}

TEST(Hollow, TilesStayTilesAndAreCoveredByThem) {
    VoxelAsset asset = assetOf({});
    VoxelModel& model = asset.models[0];
    model.fillTile({0, 0, 0}, 8, 1);    // a whole region
    model.fillTile({256, 0, 0}, 6, 0);  // beside it, between it and air
    model.set({320, 5, 5}, 2);
    const std::uint64_t bricks = model.regions()[1]->brickCount();
    const HollowReport report = hollowSolids(asset);
    // Of the 64^3 cube the border is visible, but for the side at the region and the voxel that leans on it.
    EXPECT_EQ(report.hiddenVoxels, 62u * 62u * 63u + 1u);
    EXPECT_EQ(asset.models[0].regions()[1]->brickCount(), bricks);
    EXPECT_EQ(asset.models[0].at({300, 30, 30}), MaterialIndex{0});
}

TEST(Hollow, SmallestLeafCountThatAnyChoiceGives) {
    // A full cube of 8^3 with one visible material and noise inside is one leaf; with two visible ones it is
    // not.
    VoxelModel cube = test::boxModel({0, 0, 0}, {8, 8, 8}, 1);
    for (int i = 1; i < 7; ++i) cube.set({i, 3, 8 - i - 1}, static_cast<MaterialIndex>(i % 3));
    VoxelAsset asset = assetOf(std::move(cube));
    hollowSolids(asset);
    EXPECT_EQ(leavesOf(asset), 8u);  // the root is always a node
    EXPECT_EQ(asset.models[0].at({3, 3, 3}), MaterialIndex{1});
}

TEST(Hollow, GlassIsNoCoverAndIsNotTakenForFilling) {
    // A solid cube with a skin of glass: the glass must stay glass and what lies behind it is seen.
    VoxelModel cube = test::boxModel({0, 0, 0}, {8, 8, 8}, 3);
    for (int z = 1; z < 7; ++z)
        for (int y = 1; y < 7; ++y)
            for (int x = 1; x < 7; ++x) cube.set({x, y, z}, static_cast<MaterialIndex>((x + y + z) % 3));
    const VoxelModel before = test::copyOf(cube, cube.bounds());
    VoxelAsset asset = assetOf(std::move(cube));
    const HollowReport report = hollowSolids(asset);
    EXPECT_EQ(report.hiddenVoxels, 64u);
    EXPECT_EQ(expectOnlyHiddenChanged(before, asset, before.bounds()), 64u);
}

TEST(Hollow, SameResultForAnyNumberOfThreads) {
    std::vector<std::vector<std::byte>> files;
    for (const int threads : {1, 8}) {
        const tbb::global_control parallelism(tbb::global_control::max_allowed_parallelism, 8);
        tbb::task_arena arena(threads);
        arena.execute([&] {
            VoxelAsset asset = assetOf(noisyBall({0, 255, 0}, 24));
            hollowSolids(asset);
            files.push_back(encodePfVox(buildOctrees(asset, Limits{}).value(), {}).value());
        });
    }
    EXPECT_EQ(files[0], files[1]);
}

TEST(Hollow, TheFileSaysSo) {
    VoxelAsset asset = assetOf(noisyBall({0, 0, 0}, 5));
    const auto hollowedOf = [](const VoxelAsset& source) {
        const auto bytes = encodePfVox(buildOctrees(source, Limits{}).value(), {}).value();
        EXPECT_EQ(readPfVoxHeader(bytes)->optionalFeatures & kPfVoxHollow,
                  source.hollowed ? kPfVoxHollow : 0u);
        DiagnosticList diagnostics;
        return decodePfVox(bytes, Limits{}, diagnostics)->hollowed;
    };
    EXPECT_FALSE(hollowedOf(asset));
    hollowSolids(asset);
    EXPECT_TRUE(hollowedOf(asset));
}

}  // namespace
}  // namespace pfvox
