// The oracle itself, on cases that can be checked by hand and against OctreeModel::at.
#include <gtest/gtest.h>

#include <cmath>

#include "support/procedural.hpp"
#include "support/reference_caster.hpp"

namespace pfvox::test {
namespace {

OctreeAsset oneVoxelAt(glm::ivec3 voxel, const Affine& worldFromModel = identityAffine()) {
    VoxelAsset asset;
    asset.materials = {material(1, 2, 3)};
    asset.models.emplace_back().set(voxel, 0);
    asset.instances.push_back({.worldFromModel = worldFromModel});
    return build(asset);
}

TEST(ReferenceCaster, HitsEachFaceFromOutside) {
    const OctreeAsset asset = oneVoxelAt({2, 3, 4});
    const ReferenceCaster caster(asset);
    const glm::dvec3 center(2.5, 3.5, 4.5);
    for (int face = 0; face < 6; ++face) {
        glm::dvec3 normal(0.0);
        normal[face / 2] = face % 2 == 0 ? -1.0 : 1.0;
        const auto hit = caster.cast({.origin = center + 10.0 * normal, .direction = -2.0 * normal});
        ASSERT_TRUE(hit);
        EXPECT_EQ(static_cast<int>(hit->face), face);
        EXPECT_EQ(hit->voxel, glm::ivec3(2, 3, 4));
        EXPECT_DOUBLE_EQ(hit->t, 4.75);
        EXPECT_EQ(hit->normal, normal);
        EXPECT_FALSE(caster.cast({.origin = center + 10.0 * normal, .direction = normal}));
        EXPECT_FALSE(
            caster.cast({.origin = center + 10.0 * normal, .direction = -2.0 * normal, .tMax = 4.7}));
    }
}

TEST(ReferenceCaster, StartsInside) {
    const OctreeAsset asset = oneVoxelAt({0, 0, 0});
    const auto hit = ReferenceCaster(asset).cast({.origin = {0.5, 0.5, 0.5}, .direction = {1.0, 2.0, 3.0}});
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->t, 0.0);
    EXPECT_EQ(hit->face, Face::Inside);
}

TEST(ReferenceCaster, MirroredInstanceTurnsTheNormal) {
    Affine mirrored = identityAffine();
    mirrored[0] = glm::dvec3(-2.0, 0.0, 0.0);
    const OctreeAsset asset = oneVoxelAt({1, 0, 0}, mirrored);  // world x from -4 to -2
    const auto hit = ReferenceCaster(asset).cast({.origin = {5.0, 0.5, 0.5}, .direction = {-1.0, 0.0, 0.0}});
    ASSERT_TRUE(hit);
    EXPECT_DOUBLE_EQ(hit->t, 7.0);
    EXPECT_EQ(hit->face, Face::MinusX);
    EXPECT_EQ(hit->normal, glm::dvec3(1.0, 0.0, 0.0));
}

TEST(ReferenceCaster, AgreesWithSmallStepsThroughTheModel) {
    Random random(11);
    VoxelAsset voxels;
    voxels.materials.assign(6, material(9, 9, 9));
    for (std::uint8_t i = 0; i < 6; ++i) voxels.materials[i].baseColor.r = i;
    voxels.models.push_back(largeModel(6));
    voxels.instances.emplace_back();
    const OctreeAsset asset = build(voxels);
    const ReferenceCaster caster(asset);
    constexpr double kStep = 1e-3;
    for (int i = 0; i < 40; ++i) {
        const ReferenceRay ray{
            .origin = {random.uniform(0, 600), random.uniform(0, 300), random.uniform(0, 520)},
            .direction = random.direction(),
            .tMax = 40.0};
        const auto hit = caster.cast(ray);
        for (double t = 0.0; t <= 40.0; t += kStep) {
            const auto found = asset.models[0].at(glm::ivec3(glm::floor(ray.origin + t * ray.direction)));
            if (!found) continue;
            // A step may jump over the corner of a voxel, never past where the reference says that the ray
            // ends.
            ASSERT_TRUE(hit) << i;
            EXPECT_LE(hit->t, t + 1e-9) << i;
            if (hit->t > t - 2.0 * kStep) {
                EXPECT_EQ(hit->material, *found) << i;
            }
            break;
        }
        if (hit) {
            EXPECT_EQ(asset.models[0].at(hit->voxel), hit->material) << i;
        }
    }
}

}  // namespace
}  // namespace pfvox::test
