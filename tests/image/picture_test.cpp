// Pictures of scenes made here, in every view mode, against golden pictures.
#include "support/picture_fixture.hpp"

#include "support/image_compare.hpp"
#include "support/procedural.hpp"

namespace pfvox::test {
namespace {

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
        PFVOX_ASSERT_VALUE(const Shot, shot, draw(build(demoRoom()), settings));
        EXPECT_TRUE(matchesGolden(shot.picture, std::string("room-") + name));
        EXPECT_EQ(shot.statistics.cameraRays, 320u * 240u * 4u);
        EXPECT_EQ(shot.statistics.cappedRays, 0u);
    }
}

TEST_F(PictureTest, ComposedScene) {
    PFVOX_ASSERT_VALUE(const Shot, shot, draw(build(composedScene()), kSmall));
    EXPECT_TRUE(matchesGolden(shot.picture, "composed-final"));
}

TEST_F(PictureTest, EmptySceneIsSky) {
    PFVOX_ASSERT_VALUE(const Shot, shot, draw(build(VoxelAsset{}), kSmall));
    EXPECT_TRUE(matchesGolden(shot.picture, "empty-final"));
    EXPECT_EQ(shot.statistics.hits, 0u);
}

TEST_F(PictureTest, SameInputGivesSamePixels) {
    PFVOX_ASSERT_VALUE(const Shot, first, draw(build(demoRoom()), kSmall));
    PFVOX_ASSERT_VALUE(const Shot, second, draw(build(demoRoom()), kSmall));
    EXPECT_TRUE(first.picture.pixels == second.picture.pixels);
}

TEST_F(PictureTest, SizesThatAreNoMultipleOfAGroup) {
    viewer::PictureSettings settings = kSmall;
    settings.samplesPerPixel = 1;
    for (const glm::uvec2 size : {glm::uvec2(1, 1), glm::uvec2(13, 7), glm::uvec2(65, 3)}) {
        settings.width = size.x;
        settings.height = size.y;
        PFVOX_ASSERT_VALUE(const Shot, shot, draw(build(demoRoom()), settings));
        for (const std::uint32_t pixel : shot.picture.pixels) EXPECT_EQ(pixel >> 24, 255u);
    }
}

}  // namespace
}  // namespace pfvox::test
