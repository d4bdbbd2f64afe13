// Octahedral maps, packs, depth codes and borders: the table of docs/format-pf_probe.md, checked.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <pfvox/probe_maths.hpp>
#include <random>

#include "shared/probe_maths.glsl.h"

namespace pfvox {
namespace {

std::vector<glm::vec3> directions(std::size_t count) {
    std::mt19937 random(11);
    std::normal_distribution<float> normal;
    std::vector<glm::vec3> result;
    for (int x = -1; x <= 1; ++x)
        for (int y = -1; y <= 1; ++y)
            for (int z = -1; z <= 1; ++z)
                if (x != 0 || y != 0 || z != 0) result.push_back(glm::normalize(glm::vec3{x, y, z}));
    while (result.size() < count)
        result.push_back(glm::normalize(glm::vec3{normal(random), normal(random), normal(random)}));
    return result;
}

double angleBetween(glm::dvec3 a, glm::dvec3 b) {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

TEST(ProbeMaths, OctahedralMapIsItsOwnInverse) {
    double worst = 0;
    for (const glm::vec3 d : directions(1000000)) {
        const glm::vec2 o = octEncode(d);
        ASSERT_LE(std::max(std::abs(o.x), std::abs(o.y)), 1.0f);
        worst = std::max(worst, angleBetween(octDecode(o), d));
    }
    EXPECT_LT(worst, 1e-6);
}

TEST(ProbeMaths, AxesAreWhereTheDocumentSays) {
    EXPECT_EQ(octEncode({0, 0, 1}), glm::vec2(0));
    EXPECT_EQ(glm::abs(octEncode({0, 0, -1})), glm::vec2(1));
    EXPECT_EQ(octEncode({1, 0, 0}), glm::vec2(1, 0));
    EXPECT_EQ(octEncode({0, -1, 0}), glm::vec2(0, -1));
    for (const glm::vec2 corner : {glm::vec2(1, 1), glm::vec2(1, -1), glm::vec2(-1, 1), glm::vec2(-1, -1)})
        EXPECT_EQ(octDecode(corner), glm::vec3(0, 0, -1));
}

TEST(ProbeMaths, SolidAnglesSumToTheSphere) {
    const auto sumOf = [](std::uint32_t edge) {
        double sum = 0;
        for (std::uint32_t i = 0; i < edge * edge; ++i)
            sum += static_cast<double>(texelSolidAngle(i % edge, i / edge, edge));
        return sum / (4 * std::numbers::pi);
    };
    EXPECT_NEAR(sumOf(1024), 1, 2e-7);
    EXPECT_NEAR(sumOf(64), 1, 2e-7);
    EXPECT_NEAR(sumOf(16), 1, 1e-5);
    EXPECT_NEAR(sumOf(8), 1, 1e-4);
}

TEST(ProbeMaths, TexelsAreAsWideAsStated) {
    for (const std::uint32_t edge : {64u, 256u}) {
        double widest = 0;
        double narrowest = 1;
        const auto measure = [&](glm::vec3 a, glm::vec3 b) {
            widest = std::max(widest, angleBetween(a, b));
            narrowest = std::min(narrowest, angleBetween(a, b));
        };
        for (std::uint32_t y = 0; y < edge; ++y)
            for (std::uint32_t x = 0; x + 1 < edge; ++x) {
                measure(directionOfTexel(x, y, edge), directionOfTexel(x + 1, y, edge));
                measure(directionOfTexel(y, x, edge), directionOfTexel(y, x + 1, edge));
            }
        EXPECT_NEAR(widest * edge, 2 * std::sqrt(6.0), 0.01);
        EXPECT_NEAR(narrowest * edge, 2, 0.05);
        EXPECT_NEAR(static_cast<double>(shared::texelAngle(edge)) * edge, 2 * std::sqrt(6.0), 0.35);
    }
}

TEST(ProbeMaths, TexelsContainTheirCenters) {
    for (const std::uint32_t edge : {1u, 2u, 7u, 16u, 512u})
        for (std::uint32_t i = 0; i < edge * edge; ++i)
            ASSERT_EQ(texelIndex(directionOfTexel(i % edge, i / edge, edge), edge), i) << edge;
}

/// Walks over each edge of the map in space and asks which texel lies there.
TEST(ProbeMaths, BordersRepeatTheNeighborOnTheSphere) {
    for (const int n : {1, 2, 8, 14}) {
        const auto edge = static_cast<std::uint32_t>(n);
        const float step = 2.0f / static_cast<float>(n);
        for (int j = 0; j < n; ++j) {
            EXPECT_EQ(borderSource({0, j + 1}, n), glm::ivec2(0, n - 1 - j));
            EXPECT_EQ(borderSource({n + 1, j + 1}, n), glm::ivec2(n - 1, n - 1 - j));
            EXPECT_EQ(borderSource({j + 1, 0}, n), glm::ivec2(n - 1 - j, 0));
            EXPECT_EQ(borderSource({j + 1, n + 1}, n), glm::ivec2(n - 1 - j, n - 1));
            // On the left edge of the net (-1, y) and (-1, -y) are one direction.
            const float y = -1 + (static_cast<float>(j) + 0.5f) * step;
            const glm::vec3 onEdge = octDecode({-1, y});
            EXPECT_LT(glm::distance(onEdge, octDecode({-1, -y})), 1e-6f);
            const glm::ivec2 source = borderSource({0, j + 1}, n);
            EXPECT_LT(
                glm::distance(
                    onEdge,
                    octDecode({-1, shared::octOfTexel(0, static_cast<std::uint32_t>(source.y), edge).y})),
                1e-5f);
        }
        EXPECT_EQ(borderSource({0, 0}, n), glm::ivec2(n - 1, n - 1));
        EXPECT_EQ(borderSource({n + 1, 0}, n), glm::ivec2(0, n - 1));
        EXPECT_EQ(borderSource({0, n + 1}, n), glm::ivec2(n - 1, 0));
        EXPECT_EQ(borderSource({n + 1, n + 1}, n), glm::ivec2(0, 0));
        for (int y = 1; y <= n; ++y)
            for (int x = 1; x <= n; ++x) ASSERT_EQ(borderSource({x, y}, n), glm::ivec2(x - 1, y - 1));
    }
}

TEST(ProbeMaths, NormalsOfAxesAreExactAndAllAreClose) {
    for (int axis = 0; axis < 3; ++axis)
        for (const float sign : {1.0f, -1.0f}) {
            glm::vec3 n{0};
            n[axis] = sign;
            EXPECT_EQ(shared::unpackNormal(shared::packNormal(n)), n);
            EXPECT_EQ(normalOf(packDepthNormal(1234, n)), n);
            EXPECT_EQ(depthCodeOf(packDepthNormal(1234, n)), 1234u);
        }
    double worst = 0;
    for (const glm::vec3 d : directions(300000))
        worst = std::max(worst, angleBetween(shared::unpackNormal(shared::packNormal(d)), d));
    EXPECT_LT(worst * 180 / std::numbers::pi, 0.95);
    EXPECT_EQ(shared::fromSnorm8(0x80), -1.0f);  // a code that is never packed
}

TEST(ProbeMaths, DepthCodesAreTheirOwnInverse) {
    for (const DepthEncoding encoding :
         {DepthEncoding{.scale = 4, .farMetres = 100}, depthEncodingFor({0, 0, 0}, {10, 4, 10}),
          DepthEncoding{.scale = 0.01f, .farMetres = 20000}}) {
        const DepthCoder coder(encoding);
        float before = -1;
        for (std::uint32_t code = 0; code <= 65534; ++code) {
            const float metres = coder.decode(code);
            ASSERT_GT(metres, before);
            before = metres;
            ASSERT_EQ(coder.encode(metres), code);
        }
        EXPECT_NEAR(before / encoding.farMetres, 1, 1e-4);
    }
}

TEST(ProbeMaths, DecodedDepthIsWithinHalfAStep) {
    const DepthEncoding encoding{.scale = 50, .farMetres = 17};
    const DepthCoder coder(encoding);
    const double logRange = std::log(50.0 * 17 + 1);
    for (int i = 0; i <= 200000; ++i) {
        const double metres = 17.0 * i / 200000;
        const double step = (metres + 1 / 50.0) * logRange / 65534;
        const float decoded = coder.decode(coder.encode(static_cast<float>(metres)));
        ASSERT_NEAR(static_cast<double>(decoded), metres, 0.52 * step + 1e-6) << metres;
    }
}

TEST(ProbeMaths, NoDistanceIsAMiss) {
    const DepthCoder coder({.scale = 4, .farMetres = 100});
    EXPECT_EQ(coder.encode(100), 65534u);
    for (const float metres : {101.0f, 1e6f, 3e38f, INFINITY}) EXPECT_EQ(coder.encode(metres), 65534u);
    EXPECT_EQ(coder.encode(0), 0u);
    EXPECT_EQ(coder.encode(-1), 0u);
    EXPECT_TRUE(shared::isMiss(packDepthNormal(kDepthMissCode, {0, 0, 1})));
    EXPECT_FALSE(shared::isMiss(packDepthNormal(65534, {0, 0, -1})));
}

TEST(ProbeMaths, SmallFloatsAreTheirOwnInverse) {
    for (const std::uint32_t mantissaBits : {5u, 6u, 10u}) {
        float before = -1;
        for (std::uint32_t code = 0; code < (31u << mantissaBits); ++code) {
            const float value = shared::unpackSmallFloat(code, mantissaBits);
            ASSERT_GT(value, before);
            before = value;
            ASSERT_EQ(shared::packSmallFloat(value, mantissaBits), code);
        }
    }
    EXPECT_EQ(shared::unpackSmallFloat((31u << 6) - 1, 6), 65024.0f);
    EXPECT_EQ(shared::unpackSmallFloat((31u << 5) - 1, 5), 64512.0f);
    EXPECT_EQ(shared::unpackSmallFloat((31u << 10) - 1, 10), 65504.0f);
    EXPECT_EQ(shared::unpackSmallFloat(15u << 6, 6), 1.0f);
    EXPECT_TRUE(std::isinf(shared::unpackSmallFloat(31u << 6, 6)));
    EXPECT_TRUE(std::isnan(shared::unpackSmallFloat((31u << 6) + 1, 6)));
}

/// Against the definition: of the two neighbors the nearer, of two equally near the even one.
TEST(ProbeMaths, SmallFloatsAreRoundedToNearestEven) {
    std::mt19937 random(4);
    std::uniform_real_distribution<double> uniform;
    for (const std::uint32_t mantissaBits : {5u, 6u, 10u}) {
        const std::uint32_t largest = (31u << mantissaBits) - 1;
        for (int i = 0; i < 300000; ++i) {
            const auto code = static_cast<std::uint32_t>(random() % largest);
            const double low = static_cast<double>(shared::unpackSmallFloat(code, mantissaBits));
            const double high = static_cast<double>(shared::unpackSmallFloat(code + 1, mantissaBits));
            const double middle = (low + high) / 2;
            const auto value = static_cast<float>(i % 3 == 0 ? middle : low + (high - low) * uniform(random));
            const double exact = static_cast<double>(value);
            const std::uint32_t expected =
                exact < middle || (exact == middle && code % 2 == 0) ? code : code + 1;
            ASSERT_EQ(shared::packSmallFloat(value, mantissaBits), expected) << value;
        }
    }
}

TEST(ProbeMaths, LightOutOfRangeIsClamped) {
    EXPECT_EQ(packLight({-1, -INFINITY, -0.0f}), 0u);
    EXPECT_EQ(packLight({std::nanf(""), 1e-30f, 1e-45f}), 0u);
    EXPECT_EQ(unpackLight(packLight({INFINITY, 1e9f, 65024})), glm::vec3(65024, 65024, 64512));
    EXPECT_TRUE(shared::isFiniteLight(packLight({INFINITY, INFINITY, INFINITY})));
    EXPECT_EQ(unpackLight(packLight({1, 0.5f, 2})), glm::vec3(1, 0.5f, 2));
}

TEST(ProbeMaths, FiniteLightIsTold) {
    for (const int shift : {0, 11, 22}) {
        const std::uint32_t bits = shift == 22 ? 5 : 6;
        EXPECT_FALSE(shared::isFiniteLight((31u << bits) << shift));
        EXPECT_FALSE(shared::isFiniteLight(((31u << bits) + 3) << shift));
        EXPECT_TRUE(shared::isFiniteLight(((31u << bits) - 1) << shift));
    }
}

TEST(ProbeMaths, PackingLightHasNoBias) {
    std::mt19937 random(9);
    std::uniform_real_distribution<double> exponent(-8, 8);
    glm::dvec3 sum{0};
    glm::dvec3 worst{0};
    const int count = 1000000;
    for (int i = 0; i < count; ++i) {
        const auto value = static_cast<float>(std::exp2(exponent(random)));
        const glm::dvec3 relative =
            glm::dvec3(unpackLight(packLight(glm::vec3{value}))) / static_cast<double>(value) - 1.0;
        sum += relative;
        worst = glm::max(worst, glm::abs(relative));
    }
    for (int channel = 0; channel < 3; ++channel) EXPECT_LT(std::abs(sum[channel] / count), 1e-4);
    EXPECT_LT(worst.r, 0.00782);
    EXPECT_LT(worst.b, 0.01563);
}

TEST(ProbeMaths, MomentsRoundTrip) {
    for (float d = 0.001f; d <= 1; d += 0.0007f) {
        const glm::vec2 back = unpackMoments(packMoments({d, d * d}));
        ASSERT_NEAR(back.x, d, d * 0.0005f);
        ASSERT_NEAR(back.y, d * d, d * d * 0.0005f + 3e-8f);
    }
    EXPECT_EQ(unpackMoments(packMoments({0, 1})), glm::vec2(0, 1));
}

TEST(ProbeMaths, SurfaceTestTakesWhatATexelCanSee) {
    const DepthCoder coder({.scale = 50, .farMetres = 20});
    const glm::vec3 toPoint{0, 0, 5};
    const auto sees = [&](float stored, glm::vec3 storedNormal, glm::vec3 normal) {
        return seesSurface(packDepthNormal(coder.encode(stored), storedNormal), toPoint, normal, 1024, coder);
    };
    const glm::vec3 facing{0, 0, -1};
    EXPECT_TRUE(sees(5, facing, facing));
    // Head on: 1 cm + 0.75 texels of 0.255 degrees at 5 m = 2.67 cm.
    EXPECT_TRUE(sees(5.025f, facing, facing));
    EXPECT_FALSE(sees(5.029f, facing, facing));
    EXPECT_FALSE(sees(4.971f, facing, facing));
    // At 75 degrees: 1 cm + 1.67 cm / 0.2588 = 7.4 cm.
    const glm::vec3 grazing = glm::normalize(glm::vec3{0.9659f, 0, -0.2588f});
    EXPECT_TRUE(sees(5.07f, grazing, grazing));
    EXPECT_FALSE(sees(5.08f, grazing, grazing));
    // Another surface.
    EXPECT_FALSE(sees(5, {0, 1, 0}, facing));
    EXPECT_FALSE(seesSurface(packDepthNormal(kDepthMissCode, facing), toPoint, facing, 1024, coder));
}

TEST(ProbeMaths, AMapSeesWhatNearlyHalfOfItsTexelsAroundSee) {
    const DepthCoder coder({.scale = 50, .farMetres = 20});
    constexpr std::uint32_t kEdge = 16;
    // The way back from there is where the map's border is crossed.
    for (const glm::vec3 toPoint : {glm::vec3{1, 2, 3}, glm::vec3{2, -1, -4}, glm::vec3{0.01f, 0.02f, -5}}) {
        const glm::vec3 normal = -glm::normalize(toPoint);
        const std::uint32_t same = packDepthNormal(coder.encode(glm::length(toPoint)), normal);
        const std::uint32_t nothing = packDepthNormal(kDepthMissCode, normal);
        std::vector<std::uint32_t> words(kEdge * kEdge, same);
        EXPECT_TRUE(mapSeesSurface(words, toPoint, normal, kEdge, coder));
        EXPECT_FALSE(mapSeesSurface(words, toPoint, -normal, kEdge, coder));
        // Without the texel that it falls into, whose weight is a quarter at least.
        words[texelIndex(toPoint, kEdge)] = nothing;
        const glm::vec2 at = (octEncode(toPoint) * 0.5f + 0.5f) * static_cast<float>(kEdge);
        const glm::vec2 off = glm::abs(glm::fract(at) - 0.5f);
        EXPECT_EQ(mapSeesSurface(words, toPoint, normal, kEdge, coder), (1 - off.x) * (1 - off.y) <= 0.55f);
        std::ranges::fill(words, nothing);
        EXPECT_FALSE(mapSeesSurface(words, toPoint, normal, kEdge, coder));
    }
    // At the edge of the net the other texel of a pair is the mirrored one: the whole weight, not half.
    const glm::vec3 low = octDecode({-0.3f, -0.999f});
    std::vector<std::uint32_t> words(kEdge * kEdge, packDepthNormal(coder.encode(3.0f), -low));
    EXPECT_TRUE(mapSeesSurface(words, 3.0f * low, -low, kEdge, coder));
    for (std::uint32_t x = 0; x < kEdge / 2; ++x) words[x] = packDepthNormal(kDepthMissCode, low);
    EXPECT_TRUE(mapSeesSurface(words, 3.0f * low, -low, kEdge, coder));
    for (std::uint32_t x = 0; x < kEdge; ++x) words[x] = packDepthNormal(kDepthMissCode, low);
    EXPECT_FALSE(mapSeesSurface(words, 3.0f * low, -low, kEdge, coder));
}

TEST(ProbeMaths, FarIsTheDiagonalOfTheScene) {
    const DepthEncoding encoding = depthEncodingFor({-1, 0, 2}, {2, 4, 14});
    EXPECT_FLOAT_EQ(encoding.farMetres, 13);
    EXPECT_TRUE(encoding.scale > 0);
    EXPECT_GT(depthEncodingFor({1, 1, 1}, {1, 1, 1}).farMetres, 0);  // a scene without extent
}

}  // namespace
}  // namespace pfvox
