#include <gtest/gtest.h>

#include <set>

#include <pfvox/voxel_model.hpp>

#include "support/voxel_models.hpp"

namespace pfvox {
namespace {

TEST(CompactMaterials, DropsUnusedAndJoinsEqualOnes) {
    VoxelAsset asset;
    asset.materials = {{.baseColor = {1, 1, 1, 255}},
                       {.baseColor = {2, 2, 2, 255}},
                       {.baseColor = {1, 1, 1, 255}},
                       {.baseColor = {9, 9, 9, 255}},
                       {.baseColor = {2, 2, 2, 255}, .name = "named"}};
    VoxelModel model;
    model.set({0, 0, 0}, 2);
    model.set({1, 0, 0}, 0);
    model.set({2, 0, 0}, 4);
    model.fillTile({256, 0, 0}, 8, 2);
    model.fillTile({0, 8, 0}, 3, 4);
    asset.models.push_back(std::move(model));
    compactMaterials(asset);

    ASSERT_EQ(asset.materials.size(), 2u);
    EXPECT_EQ(asset.materials[0].baseColor, glm::u8vec4(1, 1, 1, 255));
    EXPECT_EQ(asset.materials[1].name, "named");
    EXPECT_EQ(asset.models[0].at({0, 0, 0}), MaterialIndex{0});
    EXPECT_EQ(asset.models[0].at({1, 0, 0}), MaterialIndex{0});
    EXPECT_EQ(asset.models[0].at({2, 0, 0}), MaterialIndex{1});
    EXPECT_EQ(asset.models[0].at({300, 3, 3}), MaterialIndex{0});
    EXPECT_EQ(asset.models[0].at({3, 9, 3}), MaterialIndex{1});
}

TEST(CompactMaterials, ComparesAsAFileKeepsThem) {
    VoxelAsset asset;
    asset.materials = {{.roughness = 0.5f}, {.roughness = 0.5f + 1e-7f}, {.roughness = 0.51f}};
    VoxelModel model;
    for (int i = 0; i < 3; ++i) model.set({i, 0, 0}, static_cast<MaterialIndex>(i));
    asset.models.push_back(std::move(model));
    compactMaterials(asset);
    EXPECT_EQ(asset.materials.size(), 2u);
}

TEST(Quantised, IsItsOwnFixedPoint) {
    for (int i = 0; i <= 1000; ++i) {
        const float v = static_cast<float>(i) / 1000.0f;
        const Material once = quantised({.metalness = v, .roughness = 1 - v, .phase = 2 * v - 1});
        EXPECT_EQ(quantised(once), once);
        EXPECT_NEAR(once.metalness, v, 1.0f / 65535.0f);
        EXPECT_NEAR(once.phase, 2 * v - 1, 1.0f / 32767.0f);
    }
}

// Does not compile where a property was added: then it is missing in the table, too, and in all that is made
// of it.
TEST(MaterialFields, TheTableHasEveryNumber) {
    Material m;
    auto& [color, type, a, b, c, d, e, f, g, h, name] = m;
    std::set<const float*> numbers{&a, &b, &c, &d, &e, &f, &g, &h};
    for (const MaterialField& field : kMaterialFields)
        EXPECT_EQ(numbers.erase(&(m.*field.value)), 1u) << field.name;
    EXPECT_TRUE(numbers.empty());
    EXPECT_EQ(color.a, 255);
    EXPECT_EQ(type, MaterialType::Diffuse);
    EXPECT_EQ(name, Name{});
}

}  // namespace
}  // namespace pfvox
