// Levels of detail by the size of a pixel, as pictures.
#include "support/image_compare.hpp"
#include "support/picture_fixture.hpp"
#include "support/procedural.hpp"

namespace pfvox::test {
namespace {

/// Three copies of the room, each farther away: voxels below a pixel in the last one.
VoxelAsset roomsInARow() {
    VoxelAsset asset = demoRoom();
    const Instance first = asset.instances.front();
    for (const double z : {-25.0, -120.0}) {
        asset.instances.push_back(first);
        asset.instances.back().worldFromModel[3] += glm::dvec3(3.0 - 0.9 * z, -0.15 * z, z);
    }
    return asset;
}

class LodPicture : public PictureTest {
  protected:
    void SetUp() override {
        PictureTest::SetUp();
        DiagnosticList diagnostics;
        auto octrees = buildOctrees(roomsInARow(), Limits{}, {.lod = true});
        ASSERT_TRUE(octrees);
        asset = *std::move(octrees);
        const gpu::ScenePart part{.asset = &asset};
        auto built = gpu::Scene::build(device(), {&part, 1}, diagnostics);
        ASSERT_TRUE(built);
        scene.emplace(*std::move(built));
        ASSERT_GT(scene->statistics().lodBytes, 0u);
    }
    void TearDown() override {
        scene.reset();
        PictureTest::TearDown();
    }
    viewer::Picture drawn(viewer::ViewMode mode, float lodPixels, viewer::PictureStatistics& statistics) {
        const viewer::ViewCamera camera{.position = {2.0, 4.0, 16.0}, .target = {9.0, 2.0, -8.0}};
        const viewer::PictureSettings settings{
            .width = 320, .height = 180, .mode = mode, .lodPixels = lodPixels, .lighting = {}};
        return viewer::PictureRenderer::create(device())->render(device(), *scene, camera, settings, statistics).value();
    }
    OctreeAsset asset;
    std::optional<gpu::Scene> scene;
};

TEST_F(LodPicture, CellsBecomeLargerWithDistance) {
    viewer::PictureStatistics statistics;
    EXPECT_TRUE(matchesGolden(drawn(viewer::ViewMode::Lod, 1.0f, statistics), "rooms-lod"));
    EXPECT_TRUE(matchesGolden(drawn(viewer::ViewMode::Final, 1.0f, statistics), "rooms-final"));
}

TEST_F(LodPicture, FewerStepsAndNearlyTheSamePicture) {
    viewer::PictureStatistics with;
    viewer::PictureStatistics without;
    const viewer::Picture lod = drawn(viewer::ViewMode::Final, 1.0f, with);
    const viewer::Picture full = drawn(viewer::ViewMode::Final, 0.0f, without);
    EXPECT_LT(with.steps, without.steps);
    const ImageDifference difference = differenceOf(lod, full, 24);
    EXPECT_GT(difference.largest, 0u) << "levels of detail were used";
    EXPECT_LT(static_cast<double>(difference.pixels), 0.02 * static_cast<double>(full.pixels.size()));
}

TEST_F(LodPicture, WithoutThemEveryVoxelCounts) {
    viewer::PictureStatistics statistics;
    // Dark everywhere: nothing that was hit is a level of detail.
    for (const std::uint32_t pixel : drawn(viewer::ViewMode::Lod, 0.0f, statistics).pixels)
        EXPECT_LT(pixel & 0xffu, 160u);
}

}  // namespace
}  // namespace pfvox::test
