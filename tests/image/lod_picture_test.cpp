// Levels of detail by the size of a pixel, as pictures.
#include <cmath>
#include <iostream>

#include "shown_probes.hpp"
#include "support/image_compare.hpp"
#include "support/lit_hall.hpp"
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
        return viewer::PictureRenderer::create(device())
            ->render(device(), *scene, camera, settings, statistics)
            .value();
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

/// The hall with levels of detail, lit by the field that is kept for it.
class LodLight : public LodPicture {
  protected:
    void SetUp() override {
        PictureTest::SetUp();
        writeLitHall(folder_.path());
        auto octrees = buildOctrees(litHall(), Limits{}, {.lod = true});
        ASSERT_TRUE(octrees);
        const auto bytes = encodePfVox(*octrees, EncodeSettings{});
        ASSERT_TRUE(bytes);
        writeText(folder_ / "hall.pf_vox", {reinterpret_cast<const char*>(bytes->data()), bytes->size()});
        DiagnosticList diagnostics;
        auto loaded = loadScene(folder_ / "hall.toml", Limits{}, diagnostics);
        ASSERT_TRUE(loaded) << describe(loaded.error());
        loaded_.emplace(*std::move(loaded));
        auto built = gpu::Scene::build(device(), gpu::partsOf(*loaded_), diagnostics);
        ASSERT_TRUE(built) << describe(built.error());
        scene.emplace(*std::move(built));
        ASSERT_GT(scene->statistics().lodBytes, 0u);
        const auto field = std::filesystem::path(PFVOX_TESTS_DIR) / "image/golden/hall.pf_probe";
        auto opened =
            viewer::openProbes(device(), field, *loaded_, *scene, folder_ / "hall.toml", diagnostics);
        ASSERT_TRUE(opened) << describe(opened.error());
        probes_.emplace(*std::move(opened));
    }
    void TearDown() override {
        probes_.reset();
        LodPicture::TearDown();
    }

    struct Lit {
        double byTexels = 0.0;       ///< fraction of the lookups
        std::vector<double> blocks;  ///< mean I of block x block pixels, display values
        double mean = 0.0;
        std::uint64_t steps = 0;
    };
    Lit litWith(std::uint32_t block, float lodPixels) {
        viewer::PictureSettings settings{.width = 9 * block,
                                         .height = 5 * block,
                                         .mode = viewer::ViewMode::Indirect,
                                         .lodPixels = lodPixels,
                                         .lighting = viewer::lightingOf(loaded_->scene)};
        settings.toneMap = viewer::ToneMap::Linear;
        viewer::PictureStatistics statistics;
        const viewer::ViewCamera camera = viewer::viewCameraOf(loaded_->scene.cameras.front());
        const auto renderer = viewer::PictureRenderer::create(device());
        const viewer::PictureInput input(*scene, &*probes_);
        const viewer::Picture picture =
            renderer->render(device(), input, camera, settings, statistics).value();
        EXPECT_EQ(statistics.withoutValue, 0u);
        Lit lit{.blocks = std::vector<double>(9 * 5), .steps = statistics.steps};
        for (std::size_t i = 0; i < picture.pixels.size(); ++i)
            lit.blocks[i % settings.width / block + 9 * (i / settings.width / block)] +=
                (picture.pixels[i] >> 8 & 0xffu) / static_cast<double>(block * block);
        for (const double value : lit.blocks) lit.mean += value / static_cast<double>(lit.blocks.size());
        std::uint64_t lookups = 0;
        for (const std::uint64_t tier : statistics.tiers) lookups += tier;
        lit.byTexels =
            static_cast<double>(statistics.tiers[static_cast<std::size_t>(gpu::ProbeTier::Texels)]) /
            static_cast<double>(lookups);
        return lit;
    }

  private:
    TempFolder folder_;
    std::optional<LoadedScene> loaded_;
    std::optional<viewer::ShownProbes> probes_;
};

TEST_F(LodLight, IsThatOfTheVoxels) {
    for (const auto& [block, lodPixels] : {std::pair(8u, 4.0f), std::pair(2u, 1.0f)}) {
        const Lit full = litWith(block, 0.0f);
        const Lit lod = litWith(block, lodPixels);
        double apart = 0.0;
        for (std::size_t i = 0; i < full.blocks.size(); ++i)
            apart += std::abs(lod.blocks[i] - full.blocks[i]) / static_cast<double>(full.blocks.size());
        std::cout << "  " << lodPixels << " pixels: by texels " << lod.byTexels << " of " << full.byTexels
                  << ", mean " << lod.mean / full.mean << ", blocks apart " << apart / full.mean << ", steps "
                  << static_cast<double>(lod.steps) / static_cast<double>(full.steps) << "\n";
        EXPECT_GT(lod.byTexels, full.byTexels - 0.03);
        EXPECT_NEAR(lod.mean / full.mean, 1.0, 0.03);
        EXPECT_LT(apart / full.mean, 0.08);
        EXPECT_LT(lod.steps, full.steps) << "levels of detail were used";
    }
}

}  // namespace
}  // namespace pfvox::test
