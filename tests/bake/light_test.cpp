// Light whose value is known: furnaces, skies, form factors, and a reference path tracer.
#include <cmath>
#include <iostream>
#include <numbers>
#include <pfvox/probe_maths.hpp>

#include "bake_fixture.hpp"
#include "support/reference_light.hpp"

namespace pfvox::test {
namespace {

/// Free space of demoRoom().
const glm::vec3 kInTheRoom(3.8f, 2.5f, 4.8f);

class LightTest : public BakeTest {};

double texelsWithin(const LitProbe& probe, double expected, double sigmas) {
    double within = 0.0;
    for (std::size_t i = 0; i < probe.light.size(); ++i)
        within += std::abs(static_cast<double>(probe.light[i].x) - expected) <=
                  sigmas * probe.errors[i] + 1e-4 * expected;
    return within / static_cast<double>(probe.light.size());
}

/// What one texel stands for on the surface that it sees, square metres.
double areaOf(const LitProbe& probe, std::size_t i, std::uint32_t edge) {
    const auto x = static_cast<std::uint32_t>(i) % edge;
    const auto y = static_cast<std::uint32_t>(i) / edge;
    const glm::vec3 d = directionOfTexel(x, y, edge);
    const double metres = static_cast<double>(probe.seen[i].metres);
    const double cosine = std::abs(static_cast<double>(glm::dot(d, probe.normals[i])));
    return static_cast<double>(texelSolidAngle(x, y, edge)) * metres * metres / cosine;
}

glm::vec3 pointOf(const LitProbe& probe, std::size_t i, std::uint32_t edge, const glm::vec3& position) {
    const auto index = static_cast<std::uint32_t>(i);
    return position + probe.seen[i].metres * directionOfTexel(index % edge, index / edge, edge);
}

// --- Furnaces ---

TEST_F(LightTest, AFurnaceHasTheLightOfItsSeries) {
    for (const std::uint8_t byte : {std::uint8_t{188}, std::uint8_t{243}}) {
        const double rho = linearOf(byte);
        const LoadedScene scene = sceneOf(assetOf(hollowBox(glm::ivec3(10)), {gray(byte, 0.5)}));
        const LitProbe probe = lightAt(scene, {0.43f, 0.51f, 0.38f}, plain(16, 256));
        const double expected = 0.5 / (1.0 - rho);
        std::cout << "  albedo " << rho << ": mean " << meanLight(probe) << ", expected " << expected
                  << ", within 3 sigma " << texelsWithin(probe, expected, 3.0) << ", rays " << probe.rays
                  << "\n";
        EXPECT_NEAR(meanLight(probe) / expected, 1.0, 0.005);
        // Sixteen batches each: of 256 texels, 0.8 % of a t distribution lies outside.
        EXPECT_GE(texelsWithin(probe, expected, 3.0), 0.97);
    }
}

TEST_F(LightTest, AWhiteHouseOfHalfLightIsOne) {
    // The scene of pbrt's analytic tests: reflectance 1/2, emission 1/2, hence radiance 1 everywhere.
    const double rho = linearOf(188);
    const LoadedScene scene = sceneOf(assetOf(hollowBox(glm::ivec3(10)), {gray(188, 0.5)}));
    for (const LightSampling sampling : {LightSampling::Combined, LightSampling::Directions}) {
        BakeSettings settings = plain(16, 256);
        settings.sampling = sampling;
        const double radiance = 0.5 + rho * meanLight(lightAt(scene, {0.43f, 0.51f, 0.38f}, settings));
        std::cout << "  radiance " << radiance << " with reflectance " << rho << "\n";
        EXPECT_NEAR(radiance, 0.5 / (1.0 - rho), 0.005);
        EXPECT_NEAR(radiance, 1.0, 0.006);  // sRGB has no byte for 1/2: 188 is 0.5029
    }
}

TEST_F(LightTest, BouncesAreCountedAsTheSettingSays) {
    const double rho = linearOf(188);
    const LoadedScene scene = sceneOf(assetOf(hollowBox(glm::ivec3(10)), {gray(188, 1.0)}));
    for (const std::uint32_t bounces : {0u, 1u, 2u, 5u}) {
        BakeSettings settings = plain(16, 64);
        settings.maxBounces = bounces;
        const double expected = (1.0 - std::pow(rho, bounces + 1.0)) / (1.0 - rho);
        EXPECT_NEAR(meanLight(lightAt(scene, {0.43f, 0.51f, 0.38f}, settings)) / expected, 1.0, 0.005)
            << bounces;
    }
}

TEST_F(LightTest, ATurnedAndStretchedFurnaceIsTheSame) {
    const double a = 30.0 * std::numbers::pi / 180.0;
    const glm::dmat3 turn{{std::cos(a), 0.0, -std::sin(a)}, {0.0, 1.0, 0.0}, {std::sin(a), 0.0, std::cos(a)}};
    const glm::dmat3 tilt{{std::cos(a), std::sin(a), 0.0}, {-std::sin(a), std::cos(a), 0.0}, {0.0, 0.0, 1.0}};
    const glm::dmat3 stretch{{2.0, 0.0, 0.0}, {0.0, 0.5, 0.0}, {0.0, 0.0, 1.3}};
    for (const glm::dmat3& m : {turn * tilt * stretch, stretch * turn * tilt,
                                turn * glm::dmat3{{-1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}}) {
        const Affine world{m[0], m[1], m[2], glm::dvec3(3.0, -2.0, 5.0)};
        const LoadedScene scene = sceneOf(assetOf(hollowBox(glm::ivec3(10)), {gray(188, 1.0)}), world);
        const glm::vec3 inside(world * glm::dvec4(0.43, 0.51, 0.38, 1.0));
        const double expected = 1.0 / (1.0 - linearOf(188));
        EXPECT_NEAR(meanLight(lightAt(scene, inside, plain(16, 128))) / expected, 1.0, 0.005);
    }
}

TEST_F(LightTest, EnergyIsConserved) {
    // A lamp in one corner of a gray room, everything seen by one probe: what is absorbed is what is emitted.
    VoxelModel room = hollowBox(glm::ivec3(10, 8, 12));
    for (int x = 2; x < 6; ++x)
        for (int z = 3; z < 7; ++z) room.set({x, 8, z}, 1);
    const LoadedScene scene = sceneOf(assetOf(std::move(room), {gray(200), gray(120, 3.0)}));
    constexpr std::uint32_t kEdge = 64;
    const LitProbe probe = lightAt(scene, {0.52f, 0.37f, 0.66f}, plain(kEdge, 64));
    double absorbed = 0.0;
    double surface = 0.0;
    for (std::size_t i = 0; i < probe.light.size(); ++i) {
        const double area = areaOf(probe, i, kEdge);
        surface += area;
        absorbed += (1.0 - static_cast<double>(probe.seen[i].albedo.x)) *
                    static_cast<double>(probe.light[i].x) * area;
    }
    const double emitted = 3.0 * 16 * 0.01;
    std::cout << "  absorbed / emitted " << absorbed / emitted << ", area " << surface << " of 5.92\n";
    EXPECT_NEAR(absorbed / emitted, 1.0, 0.01);
}

// --- Sky ---

TEST_F(LightTest, AWhiteSkyGivesOne) {
    LoadedScene scene = sceneOf(assetOf(hollowBox(glm::ivec3(1), 1), {gray(255)}));
    scene.scene.sky = {.zenith = glm::dvec3(1.0), .horizon = glm::dvec3(1.0), .ground = glm::dvec3(1.0)};
    const LitProbe probe = lightAt(scene, {1.0f, 0.4f, 0.2f}, plain(32, 16));
    std::size_t seen = 0;
    for (std::size_t i = 0; i < probe.light.size(); ++i) {
        if (probe.seen[i].metres < 0.0f) continue;
        ++seen;
        EXPECT_NEAR(unpackLight(packLight(probe.light[i])).x, 1.0f, 1e-3f);
    }
    EXPECT_GT(seen, 4u);
}

/// Cosine-weighted share of the hemisphere above a floor at x metres from a wall of a finite size.
double skyFraction(double x, double z, double wallHeight, double wallZ0, double wallZ1) {
    double fraction = 0.0;
    constexpr int kSteps = 400;
    for (int i = 0; i < kSteps; ++i) {
        for (int j = 0; j < kSteps; ++j) {
            const double r = std::sqrt((i + 0.5) / kSteps);
            const double angle = 2.0 * std::numbers::pi * (j + 0.5) / kSteps;
            const glm::dvec3 d(r * std::cos(angle), std::sqrt(1.0 - r * r), r * std::sin(angle));
            const double t = d.x < 0.0 ? -x / d.x : -1.0;
            const double hitZ = z + t * d.z;
            const bool blocked = t > 0.0 && t * d.y < wallHeight && hitZ > wallZ0 && hitZ < wallZ1;
            fraction += blocked ? 0.0 : 1.0;
        }
    }
    return fraction / (kSteps * kSteps);
}

TEST_F(LightTest, AWallHidesHalfTheSky) {
    VoxelModel corner;
    fillBox(corner, {{-1, -1, 0}, {40, 40, 60}}, [](glm::ivec3 p) -> std::optional<MaterialIndex> {
        return p.x < 0 || p.y < 0 ? std::optional<MaterialIndex>(MaterialIndex{0}) : std::nullopt;
    });
    LoadedScene scene = sceneOf(assetOf(std::move(corner), {gray(0)}));
    scene.scene.sky = {.zenith = glm::dvec3(1.0), .horizon = glm::dvec3(1.0), .ground = glm::dvec3(1.0)};
    const glm::vec3 position(0.31f, 0.4f, 3.05f);
    constexpr std::uint32_t kEdge = 32;
    const LitProbe probe = lightAt(scene, position, plain(kEdge, 256));
    double found = 0.0;
    double expected = 0.0;
    double nearest = 10.0;
    double lightThere = 0.0;
    for (std::size_t i = 0; i < probe.light.size(); ++i) {
        if (probe.seen[i].metres < 0.0f || probe.normals[i].y < 0.9f) continue;
        const glm::dvec3 p(pointOf(probe, i, kEdge, position));
        if (p.x > 1.5 || std::abs(p.z - 3.0) > 1.5) continue;
        found += static_cast<double>(probe.light[i].x);
        expected += skyFraction(p.x, p.z, 4.0, 0.0, 6.0);
        if (p.x < nearest) {
            nearest = p.x;
            lightThere = static_cast<double>(probe.light[i].x);
        }
    }
    std::cout << "  floor: found / expected " << found / expected << "; " << nearest << " m from the wall "
              << lightThere << "\n";
    EXPECT_NEAR(found / expected, 1.0, 0.005);
    EXPECT_NEAR(lightThere, 0.5, 0.06);
}

// --- Form factors ---

struct Patches {
    VoxelBox emitter;
    VoxelBox receiver;
    glm::vec3 probe;
    glm::vec3 normal;  ///< of the receiver
    VoxelBox wall{};   ///< black, around the smaller patch: hides its sides
};

double meanOnPatch(const LoadedScene& scene, const Patches& patches, const LitProbe& probe,
                   std::uint32_t edge) {
    double sum = 0.0;
    double area = 0.0;
    const glm::vec3 low = 0.1f * glm::vec3(patches.receiver.min) - 1e-3f;
    const glm::vec3 high = 0.1f * glm::vec3(patches.receiver.max) + 1e-3f;
    for (std::size_t i = 0; i < probe.light.size(); ++i) {
        if (probe.seen[i].metres < 0.0f || glm::dot(probe.normals[i], patches.normal) < 0.9f) continue;
        const glm::vec3 p = pointOf(probe, i, edge, patches.probe);
        if (glm::any(glm::lessThan(p, low)) || glm::any(glm::greaterThan(p, high))) continue;
        sum += areaOf(probe, i, edge) * static_cast<double>(probe.light[i].x);
        area += areaOf(probe, i, edge);
    }
    EXPECT_FALSE(scene.bounds.empty());
    return sum / area;
}

double formFactor(BakeSettings settings, const Patches& patches,
                  LitProbe (*trace)(const LoadedScene&, const glm::vec3&, const BakeSettings&)) {
    VoxelModel model;
    if (!patches.wall.empty()) fillBox(model, patches.wall, [](glm::ivec3) { return MaterialIndex{0}; });
    fillBox(model, patches.receiver, [](glm::ivec3) { return MaterialIndex{0}; });
    fillBox(model, patches.emitter, [](glm::ivec3) { return MaterialIndex{1}; });
    const LoadedScene scene = sceneOf(assetOf(std::move(model), {gray(0), gray(255, 1.0)}));
    settings.maxBounces = 0;
    return meanOnPatch(scene, patches, trace(scene, patches.probe, settings), settings.resolution.light);
}

TEST_F(LightTest, UnitSquaresHaveTheirFormFactors) {
    const auto trace = [](const LoadedScene& s, const glm::vec3& p, const BakeSettings& b) {
        return lightAt(s, p, b);
    };
    const Patches parallel{
        {{0, 10, 0}, {10, 11, 10}}, {{0, -1, 0}, {10, 0, 10}}, {0.5f, 0.5f, 0.5f}, {0, 1, 0}};
    const Patches corner{
        {{-1, 0, 0}, {0, 10, 10}}, {{0, -1, 0}, {10, 0, 10}}, {0.55f, 0.5f, 0.5f}, {0, 1, 0}};
    const double f1 = formFactor(plain(96, 32), parallel, trace);
    const double f2 = formFactor(plain(96, 32), corner, trace);
    std::cout << "  parallel " << f1 << " (0.19982), perpendicular " << f2 << " (0.20004)\n";
    EXPECT_NEAR(f1 / 0.19982, 1.0, 0.01);
    EXPECT_NEAR(f2 / 0.20004, 1.0, 0.01);
}

TEST_F(LightTest, FormFactorsAreReciprocal) {
    const auto trace = [](const LoadedScene& s, const glm::vec3& p, const BakeSettings& b) {
        return lightAt(s, p, b);
    };
    const VoxelBox large{{0, -1, 0}, {10, 0, 10}};
    const VoxelBox small{{-1, 2, 3}, {0, 7, 8}};
    const VoxelBox wall{{-1, 0, 0}, {0, 10, 10}};
    // A receiver's mean of I is F from it to the emitter.
    const double largeToSmall =
        formFactor(plain(96, 64), {small, large, {0.4f, 0.5f, 0.5f}, {0, 1, 0}, wall}, trace);
    const double smallToLarge =
        formFactor(plain(96, 64), {large, small, {0.4f, 0.5f, 0.5f}, {1, 0, 0}, wall}, trace);
    std::cout << "  A1 F12 " << 1.0 * largeToSmall << ", A2 F21 " << 0.25 * smallToLarge << "\n";
    EXPECT_NEAR(1.0 * largeToSmall / (0.25 * smallToLarge), 1.0, 0.01);
}

// --- Estimators ---

TEST_F(LightTest, AllWaysToFindEmittersAgree) {
    const LoadedScene scene = sceneOf(demoRoom());
    std::vector<Mean> means;
    for (const LightSampling way :
         {LightSampling::Combined, LightSampling::Emitters, LightSampling::Directions}) {
        BakeSettings settings = plain(16, 256);
        settings.sampling = way;
        settings.seed = 7 + static_cast<std::uint64_t>(way);
        means.push_back(meanWhere(lightAt(scene, kInTheRoom, settings), [](std::size_t) { return true; }));
        std::cout << "  " << means.back().value << " +- " << means.back().error << "\n";
    }
    EXPECT_GT(means[0].value, 0.0);
    for (const std::size_t other : {std::size_t{1}, std::size_t{2}}) {
        const double sigma = std::hypot(means[0].error, means[other].error);
        EXPECT_NEAR(means[0].value, means[other].value, 3.0 * sigma);
    }
    EXPECT_LT(means[0].error, means[2].error);
}

/// Slope of the logarithm of the noise over that of the number of paths.
class NoiseTest : public LightTest {
  protected:
    static double slope(bool stratified) {
        // A pit under the sky: light without the rare bright paths that make a fit a matter of luck.
        VoxelModel pit;
        fillBox(pit, {{-1, -1, -1}, {11, 8, 11}}, [](glm::ivec3 p) -> std::optional<MaterialIndex> {
            const bool inside = p.y >= 0 && p.x >= 0 && p.x < 10 && p.z >= 0 && p.z < 10;
            return inside ? std::nullopt : std::optional<MaterialIndex>(MaterialIndex{0});
        });
        LoadedScene scene = sceneOf(assetOf(std::move(pit), {gray(188)}));
        scene.scene.sky = Sky{};
        std::vector<glm::dvec2> points;
        for (const std::uint32_t samples : {16u, 64u, 256u, 1024u, 4096u}) {
            BakeSettings settings = plain(16, samples);
            settings.stratified = stratified;
            const LitProbe a = lightAt(scene, {0.43f, 0.41f, 0.58f}, settings);
            settings.seed = 99;
            const LitProbe b = lightAt(scene, {0.43f, 0.41f, 0.58f}, settings);
            double squares = 0.0;
            for (std::size_t i = 0; i < a.light.size(); ++i) {
                const glm::dvec3 d(a.light[i] - b.light[i]);
                squares += glm::dot(d, d);
            }
            points.emplace_back(std::log(samples), 0.5 * std::log(squares));
        }
        glm::dvec2 mean(0.0);
        for (const glm::dvec2& p : points) mean += p / static_cast<double>(points.size());
        double over = 0.0;
        double under = 0.0;
        for (const glm::dvec2& p : points) {
            over += (p.x - mean.x) * (p.y - mean.y);
            under += (p.x - mean.x) * (p.x - mean.x);
        }
        std::cout << "  slope " << over / under << "\n";
        return over / under;
    }
};

TEST_F(NoiseTest, OfHashesFallsByTheRoot) {
    EXPECT_NEAR(slope(false), -0.5, 0.05);
}

TEST_F(NoiseTest, OfSobolPointsFallsAtLeastAsFast) {
    EXPECT_LT(slope(true), -0.45);
}

TEST_F(LightTest, AgreesWithTheReference) {
    LoadedScene scene = sceneOf(demoRoom());
    scene.scene.sun = {.direction = {-0.3, -1.0, -0.6}, .irradiance = {3.0, 2.9, 2.7}};
    scene.scene.sky = Sky{};
    const glm::vec3 position = kInTheRoom;
    BakeSettings settings = plain(16, 1024);
    settings.maxBounces = 3;
    const LitProbe probe = lightAt(scene, position, settings);
    std::size_t compared = 0;
    for (std::size_t i = 5; i < probe.light.size() && compared < 6; i += 19) {
        if (probe.seen[i].metres < 0.0f) continue;
        ++compared;
        const glm::dvec3 normal(probe.normals[i]);
        const ReferenceLight expected =
            referenceLight(scene, glm::dvec3(pointOf(probe, i, 16, position)), normal, 20000, 3);
        const double sigma = std::hypot(expected.error, probe.errors[i]);
        const double found =
            static_cast<double>(probe.light[i].x + probe.light[i].y + probe.light[i].z) / 3.0;
        const double wanted = (expected.mean.x + expected.mean.y + expected.mean.z) / 3.0;
        std::cout << "  texel " << i << ": " << found << " +- " << probe.errors[i] << ", reference " << wanted
                  << " +- " << expected.error << "\n";
        EXPECT_GT(wanted, 0.0);
        EXPECT_NEAR(found, wanted, 3.5 * sigma);
    }
    EXPECT_EQ(compared, 6u);
}

// --- Leaks ---

TEST_F(LightTest, WallsKeepLightOut) {
    for (const int wall : {1, 4}) {
        VoxelModel rooms;
        fillBox(rooms, {{-4, -4, -4}, {20 + wall + 4, 14, 14}},
                [&](glm::ivec3 p) -> std::optional<MaterialIndex> {
                    const bool inner = p.y >= 0 && p.y < 10 && p.z >= 0 && p.z < 10;
                    const bool lit = inner && p.x >= 0 && p.x < 10;
                    const bool dark = inner && p.x >= 10 + wall && p.x < 20 + wall;
                    if (lit || dark) return std::nullopt;
                    return p.y == 10 && p.x >= 3 && p.x < 7 && p.z >= 3 && p.z < 7 ? MaterialIndex{1}
                                                                                   : MaterialIndex{0};
                });
        const LoadedScene scene = sceneOf(assetOf(std::move(rooms), {gray(200), gray(200, 5.0)}));
        const double lit = meanLight(lightAt(scene, {0.5f, 0.5f, 0.5f}, plain(16, 64)));
        const double dark =
            meanLight(lightAt(scene, {1.5f + 0.1f * static_cast<float>(wall), 0.5f, 0.5f}, plain(16, 64)));
        std::cout << "  wall of " << wall << ": lit " << lit << ", dark " << dark << "\n";
        EXPECT_GT(lit, 0.1);
        EXPECT_LE(dark, 0.01 * lit);
    }
}

}  // namespace
}  // namespace pfvox::test
