// Materials in a furnace: what loses no light leaves it as it is.
#include <iostream>

#include "bake_fixture.hpp"

namespace pfvox::test {
namespace {

class MaterialLightTest : public BakeTest {
  protected:
    /// Mean I on the walls of a furnace with a block of this material in it, over that of the empty one.
    static double furnaceWith(const Material& block) {
        VoxelModel model = hollowBox(glm::ivec3(10));
        fillBox(model, {{3, 2, 3}, {8, 5, 7}}, [](glm::ivec3) { return MaterialIndex{1}; });
        const LoadedScene scene = sceneOf(assetOf(std::move(model), {gray(188, 1.0), block}));
        const LitProbe probe = lightAt(scene, {0.15f, 0.81f, 0.18f}, plain(16, 128));
        const Mean walls = meanWhere(probe, [&](std::size_t i) {
            return probe.seen[i].albedo.x < 0.6f && probe.seen[i].albedo.x > 0.4f;
        });
        const double ratio = walls.value * (1.0 - linearOf(188));
        std::cout << "  " << toString(block.type) << ": " << ratio << " +- " << walls.error << "\n";
        return ratio;
    }
    static Material white(MaterialType type) {
        Material m;
        m.type = type;
        return m;
    }
};

TEST_F(MaterialLightTest, WhiteDiffuseLosesNothing) {
    EXPECT_NEAR(furnaceWith(white(MaterialType::Diffuse)), 1.0, 0.005);
}

TEST_F(MaterialLightTest, ClearGlassLosesNothing) {
    Material glass = white(MaterialType::Glass);
    glass.transparency = 1.0f;
    EXPECT_NEAR(furnaceWith(glass), 1.0, 0.005);
    glass.indexOfRefraction = 1.0f;
    EXPECT_NEAR(furnaceWith(glass), 1.0, 0.005);
    glass.transparency = 0.4f;  // the rest is white Lambert
    EXPECT_NEAR(furnaceWith(glass), 1.0, 0.005);
}

TEST_F(MaterialLightTest, DarkGlassLosesSome) {
    Material glass = white(MaterialType::Glass);
    glass.transparency = 1.0f;
    glass.baseColor = {128, 128, 128, 255};
    const double ratio = furnaceWith(glass);
    EXPECT_LT(ratio, 0.97);
    EXPECT_GT(ratio, 0.5);
}

TEST_F(MaterialLightTest, WhiteMetalLosesWhatTheLobeMasks) {
    Material metal = white(MaterialType::Metal);
    metal.metalness = 1.0f;
    metal.roughness = 0.1f;
    EXPECT_NEAR(furnaceWith(metal), 1.0, 0.01);
    metal.metalness = 0.5f;
    EXPECT_NEAR(furnaceWith(metal), 1.0, 0.01);
    metal.roughness = 1.0f;
    EXPECT_LT(furnaceWith(metal), 1.005);
}

TEST_F(MaterialLightTest, WhitePlasticGainsNothing) {
    Material plastic = white(MaterialType::Plastic);
    plastic.roughness = 0.1f;
    const double ratio = furnaceWith(plastic);
    EXPECT_LT(ratio, 1.01);
    EXPECT_GT(ratio, 0.95);
}

TEST_F(MaterialLightTest, ShadowsThroughGlassAgreeWithPathsThroughIt) {
    // A lamp behind a tinted pane, found either way.
    VoxelModel model = hollowBox(glm::ivec3(10));
    fillBox(model, {{0, 6, 0}, {10, 7, 10}}, [](glm::ivec3) { return MaterialIndex{1}; });
    fillBox(model, {{3, 10, 3}, {6, 11, 6}}, [](glm::ivec3) { return MaterialIndex{2}; });
    Material pane = white(MaterialType::Glass);
    pane.transparency = 0.8f;
    pane.baseColor = {230, 200, 120, 255};
    const LoadedScene scene = sceneOf(assetOf(std::move(model), {gray(188), pane, gray(255, 10.0)}));
    std::vector<Mean> means;
    for (const LightSampling way :
         {LightSampling::Combined, LightSampling::Emitters, LightSampling::Directions}) {
        BakeSettings settings = plain(16, 256);
        settings.sampling = way;
        settings.seed = 3 + static_cast<std::uint64_t>(way);
        means.push_back(
            meanWhere(lightAt(scene, {0.5f, 0.3f, 0.45f}, settings), [](std::size_t) { return true; }));
        std::cout << "  " << means.back().value << " +- " << means.back().error << "\n";
    }
    EXPECT_GT(means[0].value, 0.05);
    EXPECT_NEAR(means[0].value, means[2].value, 3.0 * std::hypot(means[0].error, means[2].error));
    // A lamp that glass mirrors is found by directions only.
    EXPECT_NEAR(means[1].value / means[0].value, 1.0, 0.08);
}

}  // namespace
}  // namespace pfvox::test
