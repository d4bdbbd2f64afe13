// Views that inspect, pixel by pixel against colors that are computed here, on a model that is turned: the
// colors of a view are figures, and a wrong one is a wrong figure.
#include <algorithm>
#include <pfvox/probe_file.hpp>
#include <pfvox/probe_maths.hpp>

#include "atlas_layout.hpp"
#include "shown_probes.hpp"
#include "support/image_compare.hpp"
#include "support/lit_hall.hpp"
#include "support/picture_fixture.hpp"
#include "support/reference_picture.hpp"

namespace pfvox::test {
namespace {

using namespace viewer;

/// About z, in radians; voxels of 0.1 m.
Affine turnedAboutZ(double angle) {
    Affine turned(0.0);
    turned[0] = 0.1 * glm::dvec3(std::cos(angle), std::sin(angle), 0.0);
    turned[1] = 0.1 * glm::dvec3(-std::sin(angle), std::cos(angle), 0.0);
    turned[2] = glm::dvec3(0.0, 0.0, 0.1);
    return turned;
}

class InspectingViews : public PictureTest {
  protected:
    static OctreeAsset turnedRoom() {
        VoxelAsset asset = demoRoom();
        asset.instances.front().worldFromModel = turnedAboutZ(0.9);
        return build(asset);
    }
    static PictureSettings settingsOf(ViewMode mode) {
        return {.width = 160, .height = 120, .samplesPerPixel = 1, .mode = mode, .lighting = {}};
    }
};

TEST_F(InspectingViews, NormalsAlbedoMaterialAndDepthOfATurnedModel) {
    const OctreeAsset asset = turnedRoom();
    for (const ViewMode mode : {ViewMode::Normals, ViewMode::Albedo, ViewMode::Material, ViewMode::Depth}) {
        const PictureSettings settings = settingsOf(mode);
        PFVOX_ASSERT_VALUE(const Shot, shot, draw(asset, settings));
        EXPECT_GT(shot.statistics.hits, 3000u);
        EXPECT_LE(
            differingFraction(shot.picture, referencePicture(asset, cameraOf(asset, settings), settings)),
            0.002)
            << toString(mode);
    }
}

// The face towards -y of a model that is turned by 0.9 about z: its normal is (sin 0.9, -cos 0.9, 0). As a
// power of 2.2 its green was 44.
TEST_F(InspectingViews, ANormalIsShownAsItIsAndNotAsAPowerOfIt) {
    VoxelAsset asset;
    asset.materials = {material(220, 20, 20)};
    fillBox(asset.models.emplace_back(), {.min = {0, 0, 0}, .max = glm::ivec3(8)},
            [](glm::ivec3) { return MaterialIndex{0}; });
    asset.instances.push_back({.model = 0, .worldFromModel = turnedAboutZ(0.9)});
    PFVOX_ASSERT_VALUE(const Shot, shot, draw(build(asset), settingsOf(ViewMode::Normals)));
    const auto shows = [&](std::uint32_t r, std::uint32_t g, std::uint32_t b) {
        return std::ranges::count_if(shot.picture.pixels, [&](std::uint32_t pixel) {
            return channelsApart(pixel, r | g << 8 | b << 16) <= 1;
        });
    };
    EXPECT_GT(shows(227, 48, 128), 20) << "255 (0.5 + 0.5 sin 0.9), 255 (0.5 - 0.5 cos 0.9), 255 / 2";
    EXPECT_GT(shows(128, 128, 255), 500) << "towards +z";
}

// Each pixel is some count on the scale of the heat map, and the counts add up to what the statistics say.
TEST_F(InspectingViews, StepsAddUpToTheStatistics) {
    constexpr int kHottest = 96;
    std::vector<std::uint32_t> scale;
    for (int steps = 0; steps <= kHottest; ++steps) scale.push_back(displayed(heatColor(steps / 96.0)));
    PFVOX_ASSERT_VALUE(const Shot, shot, draw(turnedRoom(), settingsOf(ViewMode::Steps)));
    double sum = 0.0;
    int worst = 0;
    for (const std::uint32_t pixel : shot.picture.pixels) {
        const auto nearest = std::ranges::min_element(
            scale, {}, [&](std::uint32_t color) { return channelsApart(color, pixel); });
        worst = std::max(worst, channelsApart(*nearest, pixel));
        sum += static_cast<double>(nearest - scale.begin());
    }
    EXPECT_LE(worst, 1);
    EXPECT_NEAR(sum / static_cast<double>(shot.statistics.steps), 1.0, 0.02);
}

TEST_F(InspectingViews, CellsWithoutLevelsOfDetailAreDarkAndShadedByTheirNormal) {
    const OctreeAsset asset = turnedRoom();
    PFVOX_ASSERT_VALUE(const Shot, cells, draw(asset, settingsOf(ViewMode::Lod)));
    PFVOX_ASSERT_VALUE(const Shot, normals, draw(asset, settingsOf(ViewMode::Normals)));
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < cells.picture.pixels.size(); ++i) {
        const std::uint32_t pixel = normals.picture.pixels[i];
        const glm::dvec3 normal =
            glm::dvec3(pixel & 0xffu, pixel >> 8 & 0xffu, pixel >> 16 & 0xffu) / 127.5 - 1.0;
        if (std::abs(glm::length(normal) - 1.0) > 0.05) continue;  // the background
        const double shade = 0.3 * (0.75 + 0.25 * glm::dot(normal, glm::dvec3(0.36, 0.8, 0.48)));
        int apart = 255;
        for (int log2 = 0; log2 <= 6; ++log2)
            apart = std::min(apart, channelsApart(cells.picture.pixels[i],
                                                  displayed(shade * heatColor(0.8 * (1.0 - log2 / 6.0)))));
        wrong += apart > 2 ? 1 : 0;
    }
    EXPECT_EQ(wrong, 0u);
}

class AtlasViews : public InspectingViews {
  protected:
    void SetUp() override {
        InspectingViews::SetUp();
        writeLitHall(folder.path());
        auto read = loadScene(folder / "hall.toml", Limits{}, diagnostics);
        ASSERT_TRUE(read) << describe(read.error());
        loaded.emplace(*std::move(read));
        const auto scene = gpu::Scene::build(device(), gpu::partsOf(*loaded), diagnostics);
        ASSERT_TRUE(scene) << describe(scene.error());
        auto opened = openProbes(device(), litHallProbes(device(), *loaded), *loaded, *scene,
                                 folder / "hall.toml", diagnostics);
        ASSERT_TRUE(opened) << describe(opened.error());
        probes.emplace(*std::move(opened));
    }
    void TearDown() override {
        probes.reset();
        InspectingViews::TearDown();
    }
    /// One probe's map, so large that pixels lie well within texels.
    Picture map(ViewMode mode, std::uint32_t probe) {
        PictureSettings settings = settingsOf(mode);
        settings.width = settings.height = 257;  // one for the gap
        settings.toneMap = ToneMap::Linear;
        settings.atlas.probe = static_cast<std::int32_t>(probe);
        const auto scene = gpu::Scene::build(device(), gpu::partsOf(*loaded), diagnostics);
        PictureStatistics statistics;
        const auto renderer = PictureRenderer::create(device());
        return renderer->render(device(), {*scene, &*probes}, ViewCamera{}, settings, statistics).value();
    }

    TempFolder folder;
    DiagnosticList diagnostics;
    std::optional<LoadedScene> loaded;
    std::optional<ShownProbes> probes;
};

TEST_F(AtlasViews, MapsOfAProbe) {
    PFVOX_ASSERT_VALUE(const ProbeFileReader, reader,
                       ProbeFileReader::open(probes->file, Limits{}, diagnostics));
    const std::uint32_t probe = 5;
    ASSERT_TRUE(reader.has(probe, ProbeLayer::DepthNormal) && reader.has(probe, ProbeLayer::Light));
    const auto words = [&](ProbeLayer layer, std::uint32_t edge) {
        std::vector<std::uint32_t> map(std::size_t{edge} * edge);
        EXPECT_TRUE(reader.readLayer(probe, layer, std::as_writable_bytes(std::span(map))));
        return map;
    };
    const std::uint32_t depthResolution = reader.info().resolution.depth;
    const std::uint32_t lightResolution = reader.info().resolution.light;
    const std::vector<std::uint32_t> depth = words(ProbeLayer::DepthNormal, depthResolution);
    const std::vector<std::uint32_t> light = words(ProbeLayer::Light, lightResolution);
    const auto byteOf = [](double v) { return static_cast<std::uint32_t>(std::lround(255.0 * v)); };
    const auto grayOrRgb = [&](const glm::dvec3& c) {
        return byteOf(c.x) | byteOf(c.y) << 8 | byteOf(c.z) << 16;
    };
    const auto expected = [&](ViewMode mode, std::uint32_t word) {
        if (mode == ViewMode::AtlasLight) return displayed(glm::dvec3(unpackLight(word)));
        if (depthCodeOf(word) == 65535) return displayed({0.03, 0.07, 0.25});
        if (mode == ViewMode::AtlasNormals) return grayOrRgb(0.5 + 0.5 * glm::dvec3(normalOf(word)));
        return grayOrRgb(glm::dvec3(1.0 - depthCodeOf(word) / 65534.0));
    };
    for (const ViewMode mode : {ViewMode::AtlasNormals, ViewMode::AtlasDepth, ViewMode::AtlasLight}) {
        const Picture picture = map(mode, probe);
        const std::uint32_t edge = mode == ViewMode::AtlasLight ? lightResolution : depthResolution;
        const std::vector<std::uint32_t>& texels = mode == ViewMode::AtlasLight ? light : depth;
        std::size_t wrong = 0;
        for (std::uint32_t y = 0; y < edge; ++y) {
            for (std::uint32_t x = 0; x < edge; ++x) {
                const std::uint32_t step = 256 / edge;
                const std::uint32_t pixel = picture.pixels[(y * step + step / 2) * 257 + x * step + step / 2];
                wrong += channelsApart(pixel, expected(mode, texels[x + edge * y])) > 1 ? 1u : 0u;
            }
        }
        EXPECT_EQ(wrong, 0u) << toString(mode) << " of " << edge * edge;
    }
}

// What the lookup and the tracing of the field say, in the colors of docs/viewer.md.
TEST_F(AtlasViews, TiersAndStatesHaveTheirColors) {
    const auto scene = gpu::Scene::build(device(), gpu::partsOf(*loaded), diagnostics);
    const auto renderer = PictureRenderer::create(device());
    const ViewCamera camera = viewCameraOf(loaded->scene.cameras.front());
    const auto drawn = [&](ViewMode mode, PictureStatistics& statistics) {
        return renderer->render(device(), {*scene, &*probes}, camera, settingsOf(mode), statistics).value();
    };
    // The hall's faces look along the axes: the shades that there are.
    std::vector<double> shades;
    for (const double component : {0.36, 0.8, 0.48})
        for (const double sign : {-1.0, 1.0}) shades.push_back(0.75 + 0.25 * sign * component);
    const auto countOf = [&](const Picture& picture, const glm::dvec3& color, bool shaded) {
        return static_cast<std::uint64_t>(std::ranges::count_if(picture.pixels, [&](std::uint32_t pixel) {
            if (!shaded) return channelsApart(pixel, displayed(color)) <= 1;
            return std::ranges::any_of(
                shades, [&](double s) { return channelsApart(pixel, displayed(s * color)) <= 1; });
        }));
    };
    PictureStatistics tiers;
    const Picture byTier = drawn(ViewMode::Tiers, tiers);
    const auto lookups = [&](gpu::ProbeTier tier) { return tiers.tiers[static_cast<std::size_t>(tier)]; };
    EXPECT_EQ(countOf(byTier, {0.20, 0.62, 0.24}, true), lookups(gpu::ProbeTier::Texels));
    EXPECT_EQ(countOf(byTier, {0.16, 0.36, 0.78}, true), lookups(gpu::ProbeTier::Compact));
    EXPECT_GT(lookups(gpu::ProbeTier::Texels), 1000u);
    PictureStatistics field;
    const Picture byState = drawn(ViewMode::Field, field);
    EXPECT_EQ(countOf(byState, {0.16, 0.36, 0.78}, false), field.fieldStates[0]);
    EXPECT_EQ(countOf(byState, {0.90, 0.45, 0.08}, false), field.fieldStates[2]);
    EXPECT_EQ(countOf(byState, {0.20, 0.62, 0.24}, true), field.fieldStates[1]);
}

}  // namespace
}  // namespace pfvox::test
