// Pictures lit by probes, in every view, against golden pictures; and that no surface is without indirect
// light.
#include <array>
#include <cmath>

#include "shown_probes.hpp"
#include "support/image_compare.hpp"
#include "support/lit_hall.hpp"
#include "support/picture_fixture.hpp"

namespace pfvox::test {
namespace {

using namespace viewer;

class LightPicture : public PictureTest {
  protected:
    void SetUp() override {
        PictureTest::SetUp();
        writeLitHall(folder.path());
        auto read = loadScene(folder / "hall.toml", Limits{}, diagnostics);
        ASSERT_TRUE(read) << describe(read.error());
        loaded.emplace(*std::move(read));
        auto made = gpu::Scene::build(device(), gpu::partsOf(*loaded), diagnostics);
        ASSERT_TRUE(made) << describe(made.error());
        scene.emplace(*std::move(made));
        auto opened = openProbes(device(), litHallProbes(device(), *loaded), *loaded, *scene,
                                 folder / "hall.toml", diagnostics);
        ASSERT_TRUE(opened) << describe(opened.error());
        probes.emplace(*std::move(opened));
        settings.lighting = lightingOf(loaded->scene);
        auto renders = PictureRenderer::create(device());
        ASSERT_TRUE(renders) << describe(renders.error());
        renderer.emplace(*std::move(renders));
    }
    void TearDown() override {
        renderer.reset();
        probes.reset();
        scene.reset();
        PictureTest::TearDown();
    }
    Picture drawn(bool lit, PictureStatistics& statistics) {
        const ViewCamera camera = viewCameraOf(loaded->scene.cameras.front());
        const PictureInput input(*scene, lit ? &*probes : nullptr);
        auto picture = renderer->render(device(), input, camera, settings, statistics);
        EXPECT_TRUE(picture) << describe(picture.error());
        return picture ? *std::move(picture) : Picture{};
    }
    Picture drawn(bool lit = true) {
        PictureStatistics statistics;
        return drawn(lit, statistics);
    }

    TempFolder folder;
    DiagnosticList diagnostics;
    std::optional<LoadedScene> loaded;
    std::optional<gpu::Scene> scene;
    std::optional<ShownProbes> probes;
    std::optional<PictureRenderer> renderer;
    PictureSettings settings{.width = 288, .height = 160, .samplesPerPixel = 2, .lighting = {}};
};

TEST_F(LightPicture, TheProbesBelongToTheHall) {
    EXPECT_TRUE(probes->ofThisScene)
        << "the kept field is of another hall: PFVOX_UPDATE_GOLDEN=1 bakes it again";
    EXPECT_EQ(probes->probes.size(), 24u);
    EXPECT_EQ(probes->info.resolution.depth, 64u);
}

TEST_F(LightPicture, EveryViewWithProbes) {
    for (const ViewEntry& view : viewModes()) {
        settings.mode = view.mode;
        PictureStatistics statistics;
        const Picture picture = drawn(true, statistics);
        EXPECT_TRUE(matchesGolden(picture, "hall-" + std::string(view.name))) << view.name;
        EXPECT_EQ(statistics.stepLimitRays, 0u) << view.name;
        EXPECT_EQ(statistics.withoutValue, 0u) << view.name;
    }
}

TEST_F(LightPicture, WithoutProbesTheSkyIsGuessedAndProbeViewsAreFinal) {
    PictureStatistics statistics;
    const Picture guessed = drawn(false, statistics);
    EXPECT_TRUE(matchesGolden(guessed, "hall-without-probes"));
    EXPECT_EQ(statistics.tiers, PictureStatistics{}.tiers);
    EXPECT_GT(statistics.ambientRays, 0u);
    drawn(true, statistics);
    EXPECT_EQ(statistics.ambientRays, 0u) << "with probes nothing is guessed, and no time is spent on it";
    settings.mode = ViewMode::Tiers;
    EXPECT_TRUE(drawn(false).pixels == guessed.pixels);
}

TEST_F(LightPicture, ToneMapsAndExposure) {
    settings.width = 144;
    settings.height = 80;
    settings.lighting.exposure = 4.0f;
    for (const ToneMapEntry& entry : toneMaps()) {
        settings.toneMap = entry.toneMap;
        EXPECT_TRUE(matchesGolden(drawn(), "hall-bright-" + std::string(entry.name))) << entry.name;
    }
}

TEST_F(LightPicture, OneProbeFillsTheAtlasAndPagesTurn) {
    settings.mode = ViewMode::AtlasLight;
    settings.lighting.exposure = 2.0f;
    settings.atlas = {.probe = 7};
    EXPECT_TRUE(matchesGolden(drawn(), "hall-atlas-probe"));
    // 96 x 64 pixels hold 3 x 2 maps of 32.
    settings.width = 96;
    settings.height = 64;
    settings.atlas = {.page = 0};
    const Picture first = drawn();
    settings.atlas.page = 3;
    const Picture last = drawn();
    EXPECT_FALSE(first.pixels == last.pixels);
    settings.atlas.page = 4000;
    EXPECT_TRUE(drawn().pixels == last.pixels) << "beyond the last page";
}

TEST_F(LightPicture, TimesAndCountsOfPasses) {
    PictureStatistics statistics;
    drawn(true, statistics);
    const std::uint64_t samples = 2ull * settings.width * settings.height;
    EXPECT_EQ(statistics.cameraRays, samples);
    std::uint64_t lookups = 0;
    for (const std::uint64_t tier : statistics.tiers) lookups += tier;
    EXPECT_GT(lookups, samples / 2);
    EXPECT_LE(lookups, statistics.hits);
    EXPECT_GT(statistics.sunRays, samples / 20);
    EXPECT_GT(statistics.reflectionRays, samples / 100);
    EXPECT_NEAR(sumOf(statistics.passMs), statistics.gpuMs, 1e-6);
    for (const Pass pass : {Pass::Geometry, Pass::Sun, Pass::Reflections, Pass::Light, Pass::Resolve})
        EXPECT_GT(statistics.passMs[static_cast<std::size_t>(pass)], 0.0) << toString(pass);
    EXPECT_EQ(statistics.passMs[static_cast<std::size_t>(Pass::Scene)], 0.0);
}

TEST_F(LightPicture, TheFieldAndTheOctreeMostlyAgree) {
    settings.mode = ViewMode::FieldDifference;
    PictureStatistics statistics;
    drawn(true, statistics);
    const auto& [miss, hit, unknown] = statistics.fieldStates;
    EXPECT_EQ(miss + hit + unknown, statistics.cameraRays);
    // The camera stands before the open front: rays that pass beside the hall are certain misses or unknown.
    EXPECT_GT(hit, statistics.cameraRays / 4);
    EXPECT_GT(statistics.fieldAgrees, statistics.cameraRays / 4);
}

// Emission and what it lights do not depend on the sun; a picture of I shows no albedo.
TEST_F(LightPicture, IndirectIsWhatTheBakeStored) {
    settings.mode = ViewMode::Indirect;
    settings.toneMap = ToneMap::Linear;
    const Picture with = drawn();
    settings.lighting.sunIrradiance = glm::vec3(0.0f);
    EXPECT_TRUE(drawn().pixels == with.pixels) << "the viewer's own sun is no indirect light";
}

// What an empty atlas page, a coarse field and every scene of these tests have in common: a value everywhere.
TEST_F(LightPicture, NoSurfaceOfAnySceneIsWithoutIndirectLight) {
    VoxelAsset sparse;
    Random random(7);
    sparse.materials = {material(200, 200, 200), material(90, 200, 90), material(255, 200, 90, 4.0f)};
    sparse.models.push_back(randomModel(random, 24, 0.05, 3));
    sparse.instances.push_back({.model = 0, .worldFromModel = Affine{0.1}});
    const std::array scenes{std::pair("room", build(demoRoom())), std::pair("sparse", build(sparse)),
                            std::pair("hall", build(litHall()))};
    for (const auto& [name, asset] : scenes) {
        const auto bytes = encodePfVox(asset, EncodeSettings{});
        ASSERT_TRUE(bytes);
        const std::filesystem::path file = folder / (std::string(name) + "-alone.pf_vox");
        writeText(file, {reinterpret_cast<const char*>(bytes->data()), bytes->size()});
        PFVOX_ASSERT_VALUE(LoadedScene, alone, loadScene(file, Limits{}, diagnostics));
        const glm::vec3 low(alone.bounds.min);
        const glm::vec3 high(alone.bounds.max);
        alone.probes = {.start = glm::mix(low, high, 0.2f), .step = 0.6f * (high - low), .counts = {2, 2, 2}};
        alone.scene.probes.proximityCells = {8, 8, 8};
        BakeSettings bake = quickBake();
        bake.resolution = {.depth = 16, .light = 8, .irradiance = 4, .moments = 6};
        BakeObserver observer;
        const std::filesystem::path field = probesBeside(file);
        const auto baked = bakeProbes(device(), alone, bake, field, observer, diagnostics);
        ASSERT_TRUE(baked) << describe(baked.error());
        PFVOX_ASSERT_VALUE(const gpu::Scene, built,
                           gpu::Scene::build(device(), gpu::partsOf(alone), diagnostics));
        PFVOX_ASSERT_VALUE(const ShownProbes, shown,
                           openProbes(device(), field, alone, built, file, diagnostics));
        PictureSettings small{
            .width = 128, .height = 96, .samplesPerPixel = 1, .mode = ViewMode::Tiers, .lighting = {}};
        PictureStatistics statistics;
        PFVOX_ASSERT_VALUE(
            const Picture, picture,
            renderer->render(device(), {built, &shown}, cameraOf(built.bounds(), small), small, statistics));
        std::uint64_t lookups = 0;
        for (const std::uint64_t tier : statistics.tiers) lookups += tier;
        EXPECT_GT(lookups, 1000u) << name;
        EXPECT_EQ(statistics.withoutValue, 0u) << name;
        for (const std::uint32_t pixel : picture.pixels) ASSERT_NE(pixel, 0xffff00ffu) << name << ": magenta";
    }
}

// Large pictures are drawn in bands of 2^22 pixels; a wide, low picture needs two of them here.
TEST_F(LightPicture, BandsFitTogether) {
    settings.samplesPerPixel = 1;
    settings.mode = ViewMode::Normals;
    settings.width = 16384;
    settings.height = 300;
    const Picture large = drawn();
    settings.width = 8192;
    settings.height = 150;
    const Picture half = drawn();
    std::size_t same = 0;
    for (std::size_t y = 0; y < 150; ++y)
        for (std::size_t x = 0; x < 8192; ++x)
            same += half.pixels[y * 8192 + x] == large.pixels[2 * y * 16384 + 2 * x] ? 1u : 0u;
    EXPECT_GT(static_cast<double>(same), 0.95 * 8192 * 150);
}

}  // namespace
}  // namespace pfvox::test
