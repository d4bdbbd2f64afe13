// The layers made from traced maps, against sums over every texel.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <pfvox/probe_layers.hpp>
#include <pfvox/probe_maths.hpp>
#include <random>

#include "shared/probe_maths.glsl.h"
#include "support/box_room.hpp"

namespace pfvox {
namespace {

using test::BoxRoom;

/// A map that a function of the direction fills.
template <class T, class F>
std::vector<T> mapOf(std::uint32_t edge, F&& f) {
    std::vector<T> texels;
    for (std::uint32_t y = 0; y < edge; ++y)
        for (std::uint32_t x = 0; x < edge; ++x) texels.push_back(f(directionOfTexel(x, y, edge)));
    return texels;
}

/// Light in a room: walls of different colors, boxes, one of them a lamp.
std::vector<glm::vec3> roomRadiance(const BoxRoom& room, glm::vec3 probe, std::uint32_t edge) {
    return mapOf<glm::vec3>(edge, [&](glm::vec3 d) {
        const test::RoomHit hit = room.trace(probe, d);
        if (hit.surface == 3) return glm::vec3{12, 11, 9};
        if (hit.surface > 0) return glm::vec3{0.1f, 0.3f, 0.05f} * static_cast<float>(1 + hit.surface % 4);
        return 0.5f + 0.4f * hit.normal;
    });
}

glm::dvec3 exactIrradiance(const std::vector<glm::vec3>& texels, std::uint32_t edge, glm::vec3 normal) {
    glm::dvec3 sum{0};
    for (std::uint32_t i = 0; i < texels.size(); ++i) {
        const glm::vec3 d = directionOfTexel(i % edge, i / edge, edge);
        sum += std::max(0.0, glm::dot(glm::dvec3(d), glm::dvec3(normal))) * glm::dvec3(texels[i]) *
               static_cast<double>(texelSolidAngle(i % edge, i / edge, edge));
    }
    return sum / std::numbers::pi;
}

std::vector<glm::vec3> randomNormals(int count) {
    std::mt19937 random(2);
    std::normal_distribution<float> normal;
    std::vector<glm::vec3> normals;
    for (int i = 0; i < count; ++i)
        normals.push_back(glm::normalize(glm::vec3{normal(random), normal(random), normal(random)}));
    return normals;
}

void expectBorder(const std::vector<std::uint32_t>& words, int interior) {
    const int edge = interior + 2;
    ASSERT_EQ(words.size(), static_cast<std::size_t>(edge * edge));
    for (int y = 0; y < edge; ++y)
        for (int x = 0; x < edge; ++x) {
            const glm::ivec2 source = borderSource({x, y}, interior) + 1;
            ASSERT_EQ(words[static_cast<std::size_t>(x + edge * y)],
                      words[static_cast<std::size_t>(source.x + edge * source.y)]);
        }
}

TEST(IrradianceLayer, WhiteSkyIsOneEverywhere) {
    for (const std::uint32_t edge : {16u, 48u, 512u, 37u}) {
        const std::vector<glm::vec3> white(std::size_t{edge} * edge, glm::vec3{1, 0.5f, 4});
        const auto words = irradianceLayer({edge, white}, 8);
        expectBorder(words, 8);
        for (const std::uint32_t word : words) ASSERT_EQ(shared::unpackLight(word), glm::vec3(1, 0.5f, 4));
    }
}

TEST(IrradianceLayer, DarknessIsZero) {
    const std::vector<glm::vec3> dark(32 * 32);
    for (const std::uint32_t word : irradianceLayer({32, dark}, 8)) EXPECT_EQ(word, 0u);
}

/// Sky of radiance 1 above, nothing below: E / pi = (1 + cos) / 2.
TEST(IrradianceLayer, HalfASky) {
    const std::uint32_t edge = 256;
    const auto sky = mapOf<glm::vec3>(edge, [](glm::vec3 d) { return glm::vec3{d.y > 0 ? 1.0f : 0.0f}; });
    const auto words = irradianceLayer({edge, sky}, 8);
    double squared = 0;
    const auto normals = randomNormals(3000);
    for (const glm::vec3 n : normals) {
        const float expected = (1 + n.y) / 2;
        const float found = lookupIrradiance(words, 8, n).r;
        ASSERT_NEAR(found, expected, 0.06f);
        squared += (found - expected) * (found - expected);
    }
    EXPECT_LT(std::sqrt(squared / static_cast<double>(normals.size())) / 0.5, 0.03);
}

TEST(IrradianceLayer, QuadratureOverBlocksIsThatOverTexels) {
    const std::uint32_t edge = 512;
    const BoxRoom room(24);
    const auto texels = roomRadiance(room, {4.8f, 2.1f, 5.3f}, edge);
    // A layer so fine that the lookup adds nothing.
    const auto words = irradianceLayer({edge, texels}, 24);
    double squared = 0;
    for (const glm::vec3 n : randomNormals(60)) {
        const glm::dvec3 relative =
            glm::dvec3(lookupIrradiance(words, 24, n)) / exactIrradiance(texels, edge, n) - 1.0;
        squared += glm::dot(relative, relative) / 3;
        ASSERT_LT(glm::length(relative), 0.03);  // packing alone: 0.8, 0.8 and 1.6 %
    }
    EXPECT_LT(std::sqrt(squared / 60), 0.006);
}

/// The fit is what makes 8 x 8 texels enough: nearer to E than samples of E at the texels would be.
TEST(IrradianceLayer, FitIsNearerThanSamples) {
    const std::uint32_t edge = 128;
    double fitted = 0;
    double sampled = 0;
    double mean = 0;
    for (std::uint32_t seed = 1; seed <= 6; ++seed) {
        const BoxRoom room(24, seed);
        const auto texels = roomRadiance(room, {5, 2, 5}, edge);
        const auto words = irradianceLayer({edge, texels}, 8);
        expectBorder(words, 8);
        std::vector<std::uint32_t> samples(100);
        for (int y = 0; y < 10; ++y)
            for (int x = 0; x < 10; ++x) {
                const glm::ivec2 s = borderSource({x, y}, 8);
                const glm::vec3 n =
                    directionOfTexel(static_cast<std::uint32_t>(s.x), static_cast<std::uint32_t>(s.y), 8);
                samples[static_cast<std::size_t>(x + 10 * y)] =
                    packLight(glm::vec3(exactIrradiance(texels, edge, n)));
            }
        for (const glm::vec3 n : randomNormals(300)) {
            const glm::dvec3 exact = exactIrradiance(texels, edge, n);
            const auto squaredError = [&](const std::vector<std::uint32_t>& layer) {
                const glm::dvec3 off = glm::dvec3(lookupIrradiance(layer, 8, n)) - exact;
                return glm::dot(off, off);
            };
            fitted += squaredError(words);
            sampled += squaredError(samples);
            mean += glm::dot(exact, exact);
        }
    }
    const double fittedRmse = std::sqrt(fitted / mean);
    const double sampledRmse = std::sqrt(sampled / mean);
    RecordProperty("fitted_rmse", std::to_string(fittedRmse));
    RecordProperty("sampled_rmse", std::to_string(sampledRmse));
    EXPECT_LT(fittedRmse, 0.03);
    EXPECT_LT(fittedRmse, 0.75 * sampledRmse);
}

/// One small bright lamp: unclamped least squares would swing below 0 beside it.
TEST(IrradianceLayer, IsNeverNegativeBesideALamp) {
    const std::uint32_t edge = 64;
    const auto lamp =
        mapOf<glm::vec3>(edge, [](glm::vec3 d) { return d.x > 0.99f ? glm::vec3{1000} : glm::vec3{0}; });
    const auto words = irradianceLayer({edge, lamp}, 8);
    bool hasZero = false;
    for (const std::uint32_t word : words) {
        ASSERT_TRUE(shared::isFiniteLight(word));
        hasZero = hasZero || word == 0;
    }
    EXPECT_TRUE(hasZero);
    EXPECT_LT(lookupIrradiance(words, 8, {-1, 0, 0}).r, 0.05f);
    EXPECT_GT(lookupIrradiance(words, 8, {1, 0, 0}).r, 15.0f);
}

TEST(MomentsLayer, ConstantDistance) {
    const std::vector<float> flat(64 * 64, 3.0f);
    const auto words = momentsLayer({64, flat}, 6.0f, 14);
    expectBorder(words, 14);
    for (const std::uint32_t word : words) ASSERT_EQ(unpackMoments(word), glm::vec2(0.5f, 0.25f));
}

TEST(MomentsLayer, MissesAndFarSurfacesAreOne) {
    std::vector<float> far(32 * 32, std::numeric_limits<float>::infinity());
    far[5] = 1e30f;
    for (const std::uint32_t word : momentsLayer({32, far}, 6.0f, 14))
        ASSERT_EQ(unpackMoments(word), glm::vec2(1, 1));
}

TEST(MomentsLayer, AreThoseOfTheLobeOverAllTexels) {
    const std::uint32_t edge = 512;
    const BoxRoom room(24);
    const auto distances = mapOf<float>(edge, [&](glm::vec3 d) {
        return room.trace({4.8f, 2.1f, 5.3f}, d).distance;
    });
    const float range = 4.0f;
    const auto words = momentsLayer({edge, distances}, range, 14);
    for (const std::uint32_t texel : {0u, 7u, 100u, 105u, 195u}) {
        const glm::dvec3 direction{directionOfTexel(texel % 14, texel / 14, 14)};
        glm::dvec3 sum{0};
        for (std::uint32_t i = 0; i < distances.size(); ++i) {
            const glm::dvec3 d{directionOfTexel(i % edge, i / edge, edge)};
            const double value = std::min(static_cast<double>(distances[i] / range), 1.0);
            sum += std::pow(std::max(0.0, glm::dot(d, direction)), 50) *
                   static_cast<double>(texelSolidAngle(i % edge, i / edge, edge)) *
                   glm::dvec3{1, value, value * value};
        }
        const glm::vec2 found = unpackMoments(words[texel % 14 + 1 + 16 * (texel / 14 + 1)]);
        EXPECT_NEAR(found.x / (sum.y / sum.x), 1, 0.002);
        EXPECT_NEAR(found.y / (sum.z / sum.x), 1, 0.003);
        EXPECT_GE(found.y * 1.001f, found.x * found.x);  // variance is not negative but for rounding
    }
}

TEST(MinDepthLayer, IsTheSmallestCodeOfEachBlock) {
    std::mt19937 random(6);
    for (const std::uint32_t edge : {16u, 48u, 128u}) {
        std::vector<std::uint32_t> words(std::size_t{edge} * edge);
        for (std::uint32_t& word : words) word = static_cast<std::uint32_t>(random());
        for (std::uint32_t i = 0; i < 16; ++i) words[i] |= 0xffffu;
        const auto smallest = minDepthLayer(words, edge);
        ASSERT_EQ(smallest.size(), edge / 16 * std::size_t{edge / 16});
        for (std::uint32_t b = 0; b < smallest.size(); ++b) {
            std::uint32_t expected = 65535;
            for (std::uint32_t k = 0; k < 256; ++k) {
                const std::uint32_t x = b % (edge / 16) * 16 + k % 16;
                const std::uint32_t y = b / (edge / 16) * 16 + k / 16;
                expected = std::min(expected, words[x + edge * y] & 0xffffu);
            }
            ASSERT_EQ(smallest[b], expected);
        }
    }
    const std::vector<std::uint32_t> misses(256, 0x1234ffffu);
    EXPECT_EQ(minDepthLayer(misses, 16)[0], 65535u);
}

TEST(LightLayer, IsTheMeanOfWhatSeesASurface) {
    std::vector<glm::vec3> light(16, glm::vec3{2});
    std::vector<std::uint32_t> depth(16, 100);
    light[0] = glm::vec3{100};
    depth[0] = kDepthMissCode;
    for (const std::uint32_t i : {10u, 11u, 14u, 15u}) depth[i] = kDepthMissCode;
    const auto words = lightLayer({4, light}, depth, 2);
    ASSERT_EQ(words.size(), 4u);
    for (const std::uint32_t i : {0u, 1u, 2u}) EXPECT_EQ(unpackLight(words[i]), glm::vec3(2));
    EXPECT_EQ(words[3], 0u);
    const auto same = lightLayer({4, light}, depth, 4);
    EXPECT_EQ(unpackLight(same[1]), glm::vec3(2));
    EXPECT_EQ(same[0], 0u);
}

}  // namespace
}  // namespace pfvox
