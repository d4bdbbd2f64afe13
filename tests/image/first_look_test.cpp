// Pictures without probes: what is near by hides the sky, emissive voxels light what is around them, and a
// model stands on a ground.
#include <numbers>
#include <pfvox/gpu_emitters.hpp>

#include "compose/projection.hpp"
#include "shared/color.glsl.h"
#include "support/image_compare.hpp"
#include "support/picture_fixture.hpp"
#include "support/procedural.hpp"

namespace pfvox::test {
namespace {

using namespace viewer;

constexpr double kVoxel = 0.1;

class FirstLook : public PictureTest {
  protected:
    void begin(VoxelAsset&& asset) {
        asset.instances.push_back({.model = 0, .worldFromModel = Affine{kVoxel}});
        loaded.parts.push_back({.asset = std::make_shared<const OctreeAsset>(build(asset))});
        auto made = gpu::Scene::build(device(), gpu::partsOf(loaded), diagnostics);
        ASSERT_TRUE(made) << describe(made.error());
        scene.emplace(*std::move(made));
        auto lamps = GpuEmitters::upload(device(), loaded, diagnostics);
        ASSERT_TRUE(lamps) << describe(lamps.error());
        emitters.emplace(*std::move(lamps));
    }
    void TearDown() override {
        emitters.reset();
        scene.reset();
        PictureTest::TearDown();
    }
    Picture drawn() {
        const auto renderer = PictureRenderer::create(device());
        return renderer->render(device(), {*scene, nullptr, &*emitters}, camera, settings, statistics)
            .value();
    }
    /// Mean of 5 x 5 pixels about a point of the world, linear, exposure taken back.
    glm::dvec3 radianceAt(const Picture& picture, const glm::dvec3& point) const {
        const Projection projection(camera, glm::dvec2(settings.width, settings.height));
        const auto at = projection.pointOf(point);
        EXPECT_TRUE(at);
        const glm::ivec2 middle(at.value_or(glm::dvec2(0.0)));
        glm::dvec3 sum(0.0);
        for (int y = middle.y - 2; y <= middle.y + 2; ++y) {
            for (int x = middle.x - 2; x <= middle.x + 2; ++x) {
                const std::uint32_t pixel =
                    picture
                        .pixels[static_cast<std::size_t>(y) * settings.width + static_cast<std::size_t>(x)];
                sum += shared::linearFromSrgb(
                    glm::dvec3(pixel & 0xffu, pixel >> 8 & 0xffu, pixel >> 16 & 0xffu) / 255.0);
            }
        }
        return sum / (25.0 * static_cast<double>(settings.lighting.exposure));
    }
    static Lighting dark() {
        return {.sunIrradiance = glm::vec3(0.0f),
                .skyZenith = glm::vec3(0.0f),
                .skyHorizon = glm::vec3(0.0f),
                .skyGround = glm::vec3(0.0f)};
    }
    static Lighting overcast() {
        return {.sunIrradiance = glm::vec3(0.0f),
                .skyZenith = glm::vec3(1.0f),
                .skyHorizon = glm::vec3(1.0f),
                .skyGround = glm::vec3(1.0f)};
    }

    DiagnosticList diagnostics;
    LoadedScene loaded;
    std::optional<gpu::Scene> scene;
    std::optional<GpuEmitters> emitters;
    ViewCamera camera;
    PictureStatistics statistics;
    PictureSettings settings{.width = 160, .height = 120, .toneMap = ToneMap::Linear, .lighting = {}};
};

/// A floor, 64 x 64 voxels of one gray, its upper side at y = 0.1 m; and what else `more` says.
VoxelAsset floorWith(const std::function<std::optional<MaterialIndex>(glm::ivec3)>& more) {
    VoxelAsset asset;
    asset.materials = {material(188, 188, 188), material(255, 0, 0, 100.0f)};
    fillBox(asset.models.emplace_back(), {{0, 0, 0}, {64, 32, 64}},
            [&](glm::ivec3 p) -> std::optional<MaterialIndex> {
                return p.y == 0 ? std::optional<MaterialIndex>(MaterialIndex{0}) : more(p);
            });
    return asset;
}

constexpr double kAlbedo = 0.502886;  // of byte 188

TEST_F(FirstLook, AWallHidesTheSkyFromTheFloorAtItsFoot) {
    begin(floorWith([](glm::ivec3 p) -> std::optional<MaterialIndex> {
        if (p.z < 4) return MaterialIndex{0};
        return std::nullopt;
    }));
    camera = {.position = {3.2, 6.0, 9.0}, .target = {3.2, 0.0, 2.5}, .fovYDegrees = 45.0};
    settings.lighting = overcast();
    const Picture picture = drawn();
    const double open = radianceAt(picture, {3.2, 0.1, 5.5}).y;
    const double middle = radianceAt(picture, {3.2, 0.1, 1.2}).y;
    const double foot = radianceAt(picture, {3.2, 0.1, 0.55}).y;
    EXPECT_NEAR(open, kAlbedo, 0.01) << "all of an even sky";
    EXPECT_LT(foot, 0.85 * open);
    EXPECT_LT(foot, middle);
    EXPECT_LT(middle, open);
    EXPECT_GT(statistics.ambientRays, 64u * 3000u) << "rays of a pixel in a picture";
}

/// Fraction of the light of a lamp with a square, level face that reaches a point below its middle: a
/// textbook form factor.
double formFactorBelow(double halfEdge, double height) {
    const double a = halfEdge / height;
    const double root = std::sqrt(1.0 + a * a);
    return 4.0 / (2.0 * std::numbers::pi) * 2.0 * (a / root) * std::atan(a / root);
}

TEST_F(FirstLook, ANeonLightsTheFloorBelowItAsMuchAsItsFormFactorSays) {
    begin(floorWith([](glm::ivec3 p) -> std::optional<MaterialIndex> {
        const bool neon = p.x >= 28 && p.x < 36 && p.z >= 28 && p.z < 36 && p.y == 21;
        if (neon) return MaterialIndex{1};
        if (p.x == 44 && p.z >= 16 && p.z < 48 && p.y < 24) return MaterialIndex{0};  // a wall that hides it
        return std::nullopt;
    }));
    ASSERT_EQ(emitters->count(), 8u * 8u * 2u + 4u * 8u);
    camera = {.position = {5.0, 5.0, 9.5}, .target = {3.6, 0.1, 3.2}, .fovYDegrees = 45.0};
    settings.lighting = dark();
    settings.lighting.exposure = 0.1f;
    settings.ambientRays = 64;
    const Picture picture = drawn();
    const glm::dvec3 below = radianceAt(picture, {3.2, 0.1, 3.2});
    EXPECT_NEAR(below.r / (100.0 * kAlbedo * formFactorBelow(0.4, 2.0)), 1.0, 0.04);
    EXPECT_EQ(below.g, 0.0);
    EXPECT_LT(radianceAt(picture, {4.9, 0.1, 3.2}).r, 0.02 * below.r) << "behind the wall";
}

class Ground : public FirstLook {
  protected:
    void SetUp() override {
        FirstLook::SetUp();
        VoxelAsset asset;
        asset.materials = {material(188, 120, 90)};
        fillBox(asset.models.emplace_back(), {{0, 0, 0}, {16, 16, 16}},
                [](glm::ivec3) { return MaterialIndex{0}; });
        begin(std::move(asset));
        camera = {.position = {0.8, 4.0, 6.5}, .target = {0.8, 0.3, 0.8}, .fovYDegrees = 50.0};
        settings.ground = true;
    }
};

TEST_F(Ground, ReceivesTheShadowOfTheSun) {
    settings.lighting.sunDirection = {-1.0f, -1.0f, 0.0f};  // the shadow lies towards -x, 1.6 m long
    const Picture picture = drawn();
    const double lit = radianceAt(picture, {2.4, 0.0, 1.2}).y;
    const double shaded = radianceAt(picture, {-0.6, 0.0, 1.2}).y;
    EXPECT_LT(shaded, 0.6 * lit);
    EXPECT_GT(shaded, 0.05 * lit) << "the sky lights it";
}

TEST_F(Ground, IsDarkWhereTheModelTouchesIt) {
    settings.lighting = overcast();
    const Picture picture = drawn();
    const double touching = radianceAt(picture, {0.8, 0.0, 1.78}).y;
    const double beside = radianceAt(picture, {0.8, 0.0, 2.15}).y;
    EXPECT_LT(beside, 0.4) << "the ground and not the sky";
    EXPECT_LT(touching, 0.93 * beside);
}

TEST_F(Ground, FadesIntoTheBackgroundAndIsOfTheFinalPictureAlone) {
    PictureSettings without = settings;
    without.ground = false;
    for (const ViewEntry& view : viewModes()) {
        if (view.needs != ViewNeeds::Nothing) continue;
        settings.mode = without.mode = view.mode;
        settings.ground = true;
        const Picture on = drawn();
        const std::uint64_t hits = statistics.hits;
        settings.ground = false;
        const Picture off = drawn();
        EXPECT_EQ(hits, statistics.hits) << view.name << ": the ground is no voxel";
        EXPECT_EQ(on.pixels == off.pixels, view.mode != ViewMode::Final) << view.name;
    }
    // Towards the horizon there is nothing but sky; its last trace fades.
    camera = {.position = {0.8, 1.0, 6.5}, .target = {0.8, 1.0, 0.8}, .fovYDegrees = 50.0};
    settings.mode = ViewMode::Final;
    settings.ground = true;
    const Picture on = drawn();
    settings.ground = false;
    const Picture off = drawn();
    const std::size_t left = 2;
    int largestStep = 0;
    int last = 0;
    for (std::size_t y = 0; y < settings.height; ++y) {
        const std::size_t i = y * settings.width + left;
        const int difference =
            static_cast<int>(on.pixels[i] >> 8 & 0xffu) - static_cast<int>(off.pixels[i] >> 8 & 0xffu);
        EXPECT_TRUE(difference == 0 || y >= settings.height / 2) << "row " << y;
        largestStep = std::max(largestStep, std::abs(difference - last));
        last = difference;
    }
    EXPECT_LE(largestStep, 12) << "no edge";
}

TEST_F(Ground, IsNotSeenFromBelow) {
    camera = {.position = {0.8, -4.0, 4.5}, .target = {0.8, 0.0, 0.8}, .fovYDegrees = 50.0};
    const glm::dvec3 beside{2.4, 0.0, 1.2};
    const glm::dvec3 on = radianceAt(drawn(), beside);
    settings.ground = false;
    EXPECT_EQ(on, radianceAt(drawn(), beside));
}

}  // namespace
}  // namespace pfvox::test
