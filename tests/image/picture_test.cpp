// Pictures of scenes made here, in every view mode, against golden pictures.
#include "support/picture_fixture.hpp"

#include <algorithm>

#include "support/image_compare.hpp"
#include "support/procedural.hpp"
#include "support/reference_picture.hpp"

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
        EXPECT_EQ(shot.statistics.stepLimitRays, 0u);
    }
}

TEST_F(PictureTest, ComposedScene) {
    PFVOX_ASSERT_VALUE(const Shot, shot, draw(build(composedScene()), kSmall));
    EXPECT_TRUE(matchesGolden(shot.picture, "composed-final"));
}

// The reference caster's picture of the same scene: what is hit, its normal and its color, pixel by pixel.
TEST_F(PictureTest, AgreesWithTheReferenceCaster) {
    for (const VoxelAsset& voxels : {demoRoom(), composedScene()}) {
        const OctreeAsset asset = build(voxels);
        for (const viewer::ViewMode mode : {viewer::ViewMode::Normals, viewer::ViewMode::Albedo}) {
            viewer::PictureSettings settings = kSmall;
            settings.samplesPerPixel = 1;
            settings.mode = mode;
            PFVOX_ASSERT_VALUE(const Shot, shot, draw(asset, settings));
            const viewer::Picture reference = referencePicture(asset, cameraOf(asset, settings), settings);
            const auto hits = static_cast<std::size_t>(
                std::ranges::count_if(reference.pixels, [](std::uint32_t pixel) { return pixel != 0; }));
            EXPECT_GT(hits, 10'000u);
            EXPECT_LE(differingFraction(shot.picture, reference), 0.001) << toString(mode);
            // Pixels whose ray passes an edge within a rounding may be hits on one side only.
            EXPECT_NEAR(static_cast<double>(shot.statistics.hits), static_cast<double>(hits),
                        0.001 * 320 * 240);
        }
    }
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
