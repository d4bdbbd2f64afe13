// A scene file on the GPU: several PF_VOX files under transforms of their own, ray by ray against one asset
// that the reference caster sees.
#include <gmock/gmock.h>

#include <iostream>
#include <pfvox/gpu_scene.hpp>

#include "differential.hpp"
#include "support/gpu_fixture.hpp"
#include "support/scene_assets.hpp"
#include "support/temp_folder.hpp"

namespace pfvox::test {
namespace {

constexpr const char* kScene = R"(
[[models]]
path = "noise.pf_vox"
translateVec = [3, 1, -2]
rotateVec = [0.4, -1.1, 2.0]
scaleVec = [5.0, 2.5, 3.5]          # turned, then scaled along the axes: sheared
[[models]]
path = "boxes.pf_vox"
rotateVec = [0.0, 0.7, 0.0]
metresPerVoxel = 0.3
[[models]]
path = "noise.pf_vox"
translateVec = [-4, 0, 3]
scaleVec = [-3, 3, 3]               # mirrored
[[models]]
path = "boxes.pf_vox"
visible = false
)";

/// What the scene shows, as one asset: instances and materials in the order of the parts.
OctreeAsset joined(const LoadedScene& scene) {
    OctreeAsset all;
    std::map<const OctreeAsset*, std::uint32_t> firstModel;
    for (const PlacedAsset& part : scene.parts) {
        const OctreeAsset& asset = *part.asset;
        const auto [entry, isNew] =
            firstModel.try_emplace(part.asset.get(), static_cast<std::uint32_t>(all.models.size()));
        if (isNew) {
            const auto firstMaterial = static_cast<MaterialIndex>(all.materials.size());
            all.materials.insert(all.materials.end(), asset.materials.begin(), asset.materials.end());
            for (OctreeModel model : asset.models) {
                for (OctreeRegion& region : model.regions) {
                    for (MaterialIndex& m : region.palette) m = static_cast<MaterialIndex>(m + firstMaterial);
                }
                all.models.push_back(std::move(model));
            }
        }
        for (Instance instance : asset.instances) {
            instance.model += entry->second;
            instance.worldFromModel = compose(part.worldFromAsset, instance.worldFromModel);
            all.instances.push_back(instance);
        }
    }
    return all;
}

OctreeAsset noise() {
    VoxelAsset asset;
    for (std::uint8_t i = 0; i < 9; ++i) asset.materials.push_back(material(i, 100, 200));
    asset.source.voxelSizeMetres = 0.2;
    asset.models.push_back(randomModel(7, {-3, 2, 1}, {20, 21, 18}, 0.2, 9));
    asset.instances.push_back({.model = 0, .worldFromModel = metresFromVoxels(0.2, {0.0, 0.0, 0.0})});
    return build(asset);
}

class SceneFileOnGpu : public GpuTest {
  protected:
    void SetUp() override {
        GpuTest::SetUp();
        writePfVox(folder / "noise.pf_vox", noise());
        writePfVox(folder / "boxes.pf_vox",
                   boxAsset({{0, 0, 0}, {4, 2, 3}}, 0.1, {{-3, 0, 2}, {1, 5, 0}, {6, 0, 7}}));
        writeText(folder / "scene.toml", kScene);
    }
    TempFolder folder;
    DiagnosticList diagnostics;
};

TEST_F(SceneFileOnGpu, RaysMeetWhatTheReferenceMeets) {
    PFVOX_ASSERT_VALUE(const LoadedScene, scene, loadScene(folder / "scene.toml", {}, diagnostics));
    const OctreeAsset oracle = joined(scene);
    const auto parts = gpu::partsOf(scene);
    Random random(11);
    for (const RayFamily& family : rayFamilies(random, oracle, 2000)) {
        const Comparison c = compare(device(), parts, oracle, family.rays);
        std::cout << "  " << family.name << ": " << c.rays << " rays, " << c.hits << " hits, " << c.ties
                  << " ties, " << c.disagreements << " disagreements\n";
        EXPECT_EQ(c.rays, 2000u);
        EXPECT_EQ(c.disagreements, 0u) << family.name << ": " << c.firstDisagreement;
        EXPECT_EQ(c.stepLimitReached, 0u);
    }
}

TEST_F(SceneFileOnGpu, AFileThatStandsTwiceIsThereOnce) {
    PFVOX_ASSERT_VALUE(const LoadedScene, loaded, loadScene(folder / "scene.toml", {}, diagnostics));
    PFVOX_ASSERT_VALUE(const gpu::Scene, scene,
                       gpu::Scene::build(device(), gpu::partsOf(loaded), diagnostics));
    EXPECT_EQ(scene.statistics().models, 2u);
    EXPECT_EQ(scene.statistics().instances, 5u);
    EXPECT_EQ(scene.statistics().materials, 10u);
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(scene.bounds().min[axis], loaded.bounds.min[axis], 1e-9);
        EXPECT_NEAR(scene.bounds().max[axis], loaded.bounds.max[axis], 1e-9);
    }
    EXPECT_THAT(diagnostics.entries(), ::testing::IsEmpty());
}

}  // namespace
}  // namespace pfvox::test
