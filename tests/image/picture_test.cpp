// Pictures of scenes made here, in every view mode, against golden pictures.
#include "picture.hpp"

#include <pfvox/gpu_scene.hpp>

#include "support/gpu_fixture.hpp"
#include "support/image_compare.hpp"
#include "support/procedural.hpp"

namespace pfvox::test {
namespace {

class PictureTest : public GpuTest {
  protected:
    struct Shot {
        viewer::Picture picture;
        viewer::PictureStatistics statistics;
    };
    static Result<Shot> draw(const VoxelAsset& voxels, const viewer::PictureSettings& settings) {
        const OctreeAsset asset = build(voxels);
        DiagnosticList diagnostics;
        const gpu::ScenePart part{.asset = &asset};
        PFVOX_TRY(const gpu::Scene, scene, gpu::Scene::build(device(), {&part, 1}, diagnostics));
        PFVOX_TRY(const viewer::PictureRenderer, renderer, viewer::PictureRenderer::create(device()));
        const double aspect = static_cast<double>(settings.width) / settings.height;
        const viewer::ViewCamera camera = viewer::cameraFraming(scene.bounds(), aspect, 40.0);
        Shot shot;
        PFVOX_TRY(viewer::Picture, picture,
                  renderer.render(device(), scene, camera, settings, shot.statistics));
        shot.picture = std::move(picture);
        return shot;
    }
};

const viewer::PictureSettings kSmall{.width = 320, .height = 240, .lighting = {}};

/// The room twice, one turned and mirrored, and a model of several regions in the background.
VoxelAsset composedScene() {
    VoxelAsset asset = demoRoom();
    asset.models.push_back(largeModel(4));
    asset.instances.push_back({.model = 1, .worldFromModel = Affine{0.02}});
    asset.instances.back().worldFromModel[3] = glm::dvec3(-2.0, -5.0, -8.0);
    Affine turned{0.0};
    turned[0] = glm::dvec3(0.0, 0.0, 0.1);
    turned[1] = glm::dvec3(0.0, 0.05, 0.0);
    turned[2] = glm::dvec3(0.1, 0.0, 0.0);
    turned[3] = glm::dvec3(8.0, 0.0, 0.0);
    asset.instances.push_back({.model = 0, .worldFromModel = turned});
    return asset;
}

TEST_F(PictureTest, RoomInEveryView) {
    for (const char* const name : {"final", "albedo", "normals", "material", "depth", "steps"}) {
        viewer::PictureSettings settings = kSmall;
        settings.mode = viewer::viewModeFrom(name).value();
        PFVOX_ASSERT_VALUE(const Shot, shot, draw(demoRoom(), settings));
        EXPECT_TRUE(matchesGolden(shot.picture, std::string("room-") + name));
        EXPECT_EQ(shot.statistics.cameraRays, 320u * 240u * 4u);
        EXPECT_EQ(shot.statistics.cappedRays, 0u);
    }
}

TEST_F(PictureTest, ComposedScene) {
    PFVOX_ASSERT_VALUE(const Shot, shot, draw(composedScene(), kSmall));
    EXPECT_TRUE(matchesGolden(shot.picture, "composed-final"));
}

TEST_F(PictureTest, EmptySceneIsSky) {
    PFVOX_ASSERT_VALUE(const Shot, shot, draw(VoxelAsset{}, kSmall));
    EXPECT_TRUE(matchesGolden(shot.picture, "empty-final"));
    EXPECT_EQ(shot.statistics.hits, 0u);
}

TEST_F(PictureTest, SameInputGivesSamePixels) {
    PFVOX_ASSERT_VALUE(const Shot, first, draw(demoRoom(), kSmall));
    PFVOX_ASSERT_VALUE(const Shot, second, draw(demoRoom(), kSmall));
    EXPECT_TRUE(first.picture.pixels == second.picture.pixels);
}

TEST_F(PictureTest, SizesThatAreNoMultipleOfAGroup) {
    viewer::PictureSettings settings = kSmall;
    settings.samplesPerPixel = 1;
    for (const glm::uvec2 size : {glm::uvec2(1, 1), glm::uvec2(13, 7), glm::uvec2(65, 3)}) {
        settings.width = size.x;
        settings.height = size.y;
        PFVOX_ASSERT_VALUE(const Shot, shot, draw(demoRoom(), settings));
        for (const std::uint32_t pixel : shot.picture.pixels) EXPECT_EQ(pixel >> 24, 255u);
    }
}

}  // namespace
}  // namespace pfvox::test
