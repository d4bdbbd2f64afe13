// octree_trace.glsl against the reference caster: hit, distance, instance, voxel, face, normal and material.
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <pfvox/gpu_scene.hpp>
#include <pfvox/ray_query.hpp>

#include "differential.hpp"
#include "support/gpu_fixture.hpp"

namespace pfvox::test {
namespace {

constexpr std::size_t kRaysPerFamily = 2500;

class TraceDifferential : public GpuTest {
  protected:
    /// PFVOX_TEST_RAYS multiplies the number of rays, for long runs.
    static std::size_t rayFactor() {
        const char* const factor = std::getenv("PFVOX_TEST_RAYS");
        return factor != nullptr ? std::strtoul(factor, nullptr, 10) : 1;
    }

    /// All families of rays through the scene. Prints counts; any disagreement fails.
    static void check(const VoxelAsset& voxels, std::size_t usualRaysPerFamily = kRaysPerFamily) {
        const std::size_t raysPerFamily = usualRaysPerFamily * rayFactor();
        const OctreeAsset asset = build(voxels);
        Random random(2026);
        for (const RayFamily& family : rayFamilies(random, asset, raysPerFamily)) {
            const Comparison c = compare(device(), asset, family.rays);
            std::cout << "  " << family.name << ": " << c.rays << " rays, " << c.hits << " hits, " << c.ties
                      << " ties at edges, " << c.disagreements << " disagreements\n";
            EXPECT_EQ(c.rays, raysPerFamily);
            EXPECT_EQ(c.disagreements, 0u) << family.name << ": " << c.firstDisagreement;
            EXPECT_EQ(c.stepLimitReached, 0u) << family.name;
        }
    }
};

std::vector<Material> grayMaterials(int count) {
    std::vector<Material> materials;
    for (int i = 0; i < count; ++i) {
        materials.push_back(material(static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(i >> 4), 90));
    }
    return materials;
}

Affine placed(glm::dvec3 position, const glm::dmat3& linear) {
    Affine m;
    for (int c = 0; c < 3; ++c) m[c] = linear[c];
    m[3] = position;
    return m;
}

/// Rotation about a random axis by a random angle (Rodrigues).
glm::dmat3 randomRotation(Random& random) {
    const glm::dvec3 axis = random.direction();
    const double angle = random.uniform(0.0, 6.283);
    const glm::dmat3 cross(0.0, axis.z, -axis.y, -axis.z, 0.0, axis.x, axis.y, -axis.x, 0.0);
    return glm::dmat3(1.0) + std::sin(angle) * cross + (1.0 - std::cos(angle)) * cross * cross;
}

TEST_F(TraceDifferential, DenseNoiseWithManyMaterials) {
    Random random(1);
    VoxelAsset asset;
    asset.materials = grayMaterials(700);
    asset.models.push_back(randomModel(random, 24, 0.3, 700));
    asset.instances.emplace_back();
    check(asset);
}

TEST_F(TraceDifferential, SparseNoiseAwayFromTheOrigin) {
    Random random(2);
    VoxelAsset asset;
    asset.materials = grayMaterials(5);
    VoxelModel& model = asset.models.emplace_back();
    for (int i = 0; i < 3000; ++i) {
        model.set({random.integer(-170, 29), random.integer(-60, 139), random.integer(1000, 1199)},
                  static_cast<MaterialIndex>(random.integer(0, 4)));
    }
    asset.instances.emplace_back();
    check(asset);
}

TEST_F(TraceDifferential, RoomWithLargeLeavesAndHoistedMaterials) {
    check(demoRoom());
}

TEST_F(TraceDifferential, FarPointers) {
    Random random(6);
    VoxelAsset asset;
    asset.materials = grayMaterials(40);
    VoxelModel& model = asset.models.emplace_back();
    for (int i = 0; i < 150000; ++i) {
        model.set({random.integer(0, 255), random.integer(0, 255), random.integer(0, 255)},
                  static_cast<MaterialIndex>(random.integer(0, 39)));
    }
    asset.instances.emplace_back();
    ASSERT_FALSE(build(asset).models[0].regions[0].tree.farTable.empty());
    check(asset);
}

TEST_F(TraceDifferential, SingleVoxel) {
    VoxelAsset asset;
    asset.materials = grayMaterials(1);
    asset.models.emplace_back().set({3, -2, 7}, 0);
    asset.instances.emplace_back();
    check(asset);
}

TEST_F(TraceDifferential, SeveralRegions) {
    VoxelAsset asset;
    asset.materials = grayMaterials(16);
    asset.models.push_back(largeModel(16));
    asset.instances.emplace_back();
    check(asset);
}

TEST_F(TraceDifferential, RegionsFarApart) {
    Random random(3);
    VoxelAsset asset;
    asset.materials = grayMaterials(9);
    VoxelModel& model = asset.models.emplace_back();
    for (int cluster = 0; cluster < 40; ++cluster) {
        const glm::ivec3 at(random.integer(-9000, 9000), random.integer(-3000, 3000),
                            random.integer(-9000, 9000));
        for (int i = 0; i < 200; ++i) {
            model.set(at + glm::ivec3(random.integer(0, 40), random.integer(0, 40), random.integer(0, 40)),
                      static_cast<MaterialIndex>(random.integer(0, 8)));
        }
    }
    model.fillTile({512, 0, 1024}, 9, 4);  // solid regions: root nodes that are all leaves
    asset.instances.emplace_back();
    check(asset);
}

TEST_F(TraceDifferential, RotatedMirroredShearedAndStretchedInstances) {
    Random random(4);
    VoxelAsset asset;
    asset.materials = grayMaterials(8);
    asset.models.push_back(randomModel(random, 12, 0.35, 8));
    asset.models.push_back(randomModel(random, 17, 0.08, 8));
    for (std::uint32_t i = 0; i < 14; ++i) {
        glm::dmat3 shape(random.uniform(0.05, 0.3));
        if (i % 3 == 1) shape[1] *= -1.0;
        if (i % 4 == 2) shape[0] *= 3.5;
        if (i % 5 == 3) shape[2] += 0.6 * shape[0];
        const glm::dvec3 position(random.uniform(-4, 4), random.uniform(-2, 2), random.uniform(-4, 4));
        asset.instances.push_back(
            {.model = i % 2, .worldFromModel = placed(position, randomRotation(random) * shape)});
    }
    asset.instances[5].hidden = true;
    asset.layers.push_back({.name = "off", .hidden = true});
    asset.instances[6].layer = 0;
    check(asset);
}

TEST_F(TraceDifferential, ThousandInstances) {
    Random random(5);
    VoxelAsset asset;
    asset.materials = grayMaterials(4);
    asset.models.push_back(randomModel(random, 8, 0.3, 4));
    for (int i = 0; i < 1000; ++i) {
        const glm::dvec3 position(random.uniform(-30, 30), random.uniform(-5, 5), random.uniform(-30, 30));
        asset.instances.push_back(
            {.model = 0, .worldFromModel = placed(position, 0.15 * randomRotation(random))});
    }
    check(asset, 250);
}

}  // namespace
}  // namespace pfvox::test
