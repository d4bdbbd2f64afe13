// The codec of light on faces: what it keeps, what it costs, and that a second time changes nothing.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <pfvox/face_index.hpp>
#include <random>

#include "faces/chunk_codec.hpp"
#include "faces/face_code.hpp"
#include "faces/level_runs.hpp"
#include "faces/value_planes.hpp"
#include "shared/faces.glsl.h"
#include "support/lit_faces.hpp"
#include "support/voxel_models.hpp"

namespace pfvox {
namespace {

using testing::ElementsAre;

/// The same numbers everywhere.
class Random {
  public:
    explicit Random(std::uint64_t seed) : engine_(seed) {}
    std::uint64_t next() { return engine_(); }
    /// Both ends included.
    int integer(int low, int high) {
        return low + static_cast<int>(next() % (static_cast<std::uint64_t>(high - low) + 1));
    }
    double uniform(double low, double high) {
        return low + (high - low) * static_cast<double>(next() >> 11) * 0x1p-53;
    }

  private:
    std::mt19937_64 engine_;
};

Result<std::vector<std::uint8_t>> levelsOf(std::vector<std::uint8_t> runs, std::size_t faceCount) {
    std::vector<std::uint8_t> levels(faceCount);
    PFVOX_CHECK(faces::fromRuns(std::as_bytes(std::span(runs)), levels));
    return levels;
}

TEST(FaceLevels, RunsGiveTheLevelsBack) {
    EXPECT_THAT(faces::toRuns(std::vector<std::uint8_t>(65536, 0)), ElementsAre(0x80, 0x80, 0x20));
    Random random(1);
    for (int round = 0; round < 200; ++round) {
        std::vector<std::uint8_t> levels;
        const int count = random.integer(1, 4000);
        while (static_cast<int>(levels.size()) < count) {
            const int level = random.integer(0, 4);
            levels.resize(levels.size() + static_cast<std::size_t>(random.integer(0, round)) + 1,
                          level == 4 ? kNoFaceValue : static_cast<std::uint8_t>(level));
        }
        const auto runs = faces::toRuns(levels);
        EXPECT_LE(runs.size(), levels.size());
        EXPECT_EQ(levelsOf(runs, levels.size()).value(), levels);
    }
}

TEST(FaceLevels, OtherBytesAreRefused) {
    using enum ErrorCode;
    const auto refusal = [](std::vector<std::uint8_t> runs) {
        const auto levels = levelsOf(std::move(runs), 3);
        return levels ? NothingToConvert : levels.error().code;
    };
    EXPECT_EQ(refusal({3 << 3}), NothingToConvert);
    EXPECT_EQ(refusal({}), BadStructure);
    EXPECT_EQ(refusal({2 << 3}), BadStructure);                        // too few
    EXPECT_EQ(refusal({4 << 3}), BadStructure);                        // too many
    EXPECT_EQ(refusal({1 << 3, 2 << 3}), BadStructure);                // two runs of one level
    EXPECT_EQ(refusal({3 << 3, 1}), BadStructure);                     // no face
    EXPECT_EQ(refusal({(3 << 3) + 5}), BadValue);                      // level 5
    EXPECT_EQ(refusal({0x98, 0x00}), BadStructure);                    // longer than it need be
    EXPECT_EQ(refusal({0x98}), BadStructure);                          // cut off
    EXPECT_EQ(refusal({0xf8, 0xff, 0xff, 0xff, 0x7f}), BadStructure);  // 2^32 faces
    EXPECT_EQ(refusal({0xf8, 0xff, 0xff, 0xff, 0xff, 0x01}), BadStructure);
}

std::uint32_t anyWord(Random& random) {
    return static_cast<std::uint32_t>(random.next() % (31ull << 27));
}

/// The sum of the colors and each color are within what the steps allow; a second time changes nothing. Words
/// of few bits are coarser than the steps and have twice their own.
TEST(FaceCodes, StayNearAndAreStable) {
    Random random(2);
    for (int i = 0; i < 300000; ++i) {
        const std::uint32_t word = anyWord(random);
        const faces::FaceCode code = faces::quantize(word);
        ASSERT_TRUE(faces::isFaceCode(code)) << word;
        const std::uint32_t stored = faces::dequantize(code);
        ASSERT_EQ(storedFaceValue(FaceCodec::Quantized, word), stored);
        ASSERT_EQ(faces::quantize(stored), code) << word;
        ASSERT_EQ(faces::dequantize(faces::quantize(stored)), stored);
        const glm::dvec3 a(shared::unpackRgb9e5(word));
        const glm::dvec3 b(shared::unpackRgb9e5(stored));
        const double sum = a.x + a.y + a.z;
        const double unit = std::exp2(static_cast<double>(stored >> 27) - 24);
        const double slack = (std::exp2(1.5 / 64) - 1) * sum + 1.5 * unit;
        ASSERT_LE(std::abs(b.x + b.y + b.z - sum), slack) << word;
        for (int c = 0; c < 3; ++c) ASSERT_LE(std::abs(b[c] - a[c]), slack + 2.0 / 255 * sum) << word;
    }
    EXPECT_EQ(storedFaceValue(FaceCodec::Quantized, 0), 0u);
    EXPECT_EQ(storedFaceValue(FaceCodec::Quantized, 17u << 27), 0u);  // black has one form
}

/// Beside the largest words, and all of the smallest.
TEST(FaceCodes, AreStableAtBothEnds) {
    Random random(3);
    for (int i = 0; i < 300000; ++i) {
        const auto mantissa = [&](int least) {
            return static_cast<std::uint32_t>(random.integer(least, 511));
        };
        const std::uint32_t large = 30u << 27 | mantissa(500) | mantissa(0) << 9 | mantissa(400) << 18;
        const faces::FaceCode code = faces::quantize(large);
        ASSERT_TRUE(faces::isFaceCode(code)) << large;
        ASSERT_EQ(faces::quantize(faces::dequantize(code)), code) << large;
    }
    for (std::uint32_t i = 0; i < 20 * 20 * 20; ++i) {
        const std::uint32_t small = i % 20 | i / 20 % 20 << 9 | i / 400 << 18;
        const faces::FaceCode code = faces::quantize(small);
        ASSERT_EQ(faces::quantize(faces::dequantize(code)), code) << small;
    }
}

TEST(FaceCodes, HaveNoFormBeyondTheWords) {
    EXPECT_TRUE(faces::isFaceCode({0, 0, 0}));
    EXPECT_FALSE(faces::isFaceCode({0, 1, 0}));
    EXPECT_TRUE(faces::isFaceCode({100, 200, 55}));
    EXPECT_FALSE(faces::isFaceCode({100, 200, 56}));
    EXPECT_TRUE(faces::isFaceCode({2598, 85, 85}) || faces::isFaceCode({2597, 85, 85}));
    EXPECT_FALSE(faces::isFaceCode({2598, 255, 0}));
    EXPECT_FALSE(faces::isFaceCode({2599, 85, 85}));
    EXPECT_FALSE(faces::isFaceCode({65535, 0, 0}));
}

TEST(FacePlanes, GiveTheStoredValuesBack) {
    Random random(4);
    for (const FaceCodec codec : {FaceCodec::Quantized, FaceCodec::Lossless}) {
        std::vector<std::uint32_t> values;
        for (int i = 0; i < 20000; ++i) values.push_back(i % 97 == 0 ? 0 : anyWord(random));
        std::vector<std::uint32_t> read(values.size());
        const auto planes = faces::toPlanes(codec, values);
        ASSERT_EQ(planes.size(), values.size() * faces::planeCount(codec));
        ASSERT_TRUE(faces::fromPlanes(codec, std::as_bytes(std::span(planes)), read));
        for (std::size_t i = 0; i < values.size(); ++i)
            ASSERT_EQ(read[i], storedFaceValue(codec, values[i])) << i;
        EXPECT_EQ(faces::toPlanes(codec, read), planes);
    }
}

TEST(FacePlanes, AnyBytesAreValuesOrRefused) {
    Random random(5);
    for (const FaceCodec codec : {FaceCodec::Quantized, FaceCodec::Lossless}) {
        for (int round = 0; round < 2000; ++round) {
            std::vector<std::uint8_t> planes(faces::planeCount(codec) * 5);
            for (std::uint8_t& byte : planes)
                byte = static_cast<std::uint8_t>(random.integer(0, random.integer(0, 1) == 0 ? 7 : 255));
            std::vector<std::uint32_t> values(5);
            const auto read = faces::fromPlanes(codec, std::as_bytes(std::span(planes)), values);
            if (!read) {
                EXPECT_EQ(read.error().code, ErrorCode::BadValue);
                continue;
            }
            for (const std::uint32_t value : values) EXPECT_LT(value >> 27, 31u);
        }
    }
}

TEST(FaceChunks, BeginWhereOneIsFull) {
    using Place = FaceChunkPlace;
    const FaceLightInfo info = test::faceInfo();
    EXPECT_THAT(faceChunkPlaces(info), ElementsAre(Place{0, 0, 35}, Place{2, 0, 17}, Place{3, 2, 25}));
    FaceLightInfo other{
        .instances = {{{}, {0, 0}}, {{}, {}}, {{}, {0, 5, 0, 3, 4}}, {{}, {9, 0}}, {{}, {0}}}};
    EXPECT_THAT(faceChunkPlaces(other), ElementsAre(Place{2, 1, 21}));
    other.facesPerChunk = 8;
    EXPECT_THAT(faceChunkPlaces(other), ElementsAre(Place{2, 1, 8}, Place{2, 4, 13}));
    other.facesPerChunk = 1;
    EXPECT_EQ(faceChunkPlaces(other).size(), 4u);
    EXPECT_TRUE(faceChunkPlaces({}).empty());
}

TEST(FaceIndexKey, IsOfPlacesAndMasks) {
    std::vector<VoxelModel> models;
    models.push_back(test::randomModel(6, {0, 0, 0}, {20, 20, 20}, 0.3, 1));
    const OctreeAsset built = buildOctrees(test::assetOf(std::move(models)), Limits{}).value();
    const FaceIndex index = makeFaceIndex(built.models[0], built.materials).value();
    const ContentKey key = keyOf(index);
    EXPECT_EQ(keyOf(makeFaceIndex(built.models[0], built.materials).value()), key);
    const auto changed = [&](const std::function<void(FaceIndex&)>& change) {
        FaceIndex other = index;
        change(other);
        return keyOf(other) != key;
    };
    EXPECT_TRUE(changed([](FaceIndex& i) { i.masks[3] ^= 2; }));
    EXPECT_TRUE(changed([](FaceIndex& i) { i.bricks[1].path ^= 1; }));
    EXPECT_TRUE(changed([](FaceIndex& i) { i.bricks[1].directions ^= 1; }));
    EXPECT_TRUE(changed([](FaceIndex& i) { i.regions[0].originVoxels.y += 256; }));
    const FaceInstance instance = faceInstanceOf(index);
    EXPECT_EQ(instance.index, key);
    EXPECT_THAT(instance.faceCounts, ElementsAre(index.faceCount));
}

/// Light of a hilly ground in file order, with noise: what a value costs and loses. The figures of
/// docs/decisions/051-face-light.md are from here.
class FaceCost : public testing::Test {
  protected:
    struct Cost {
        double bytes = 0;  ///< a value
        double light = 0;  ///< RMS of the relative error of the sum
        double color = 0;  ///< and of each color
    };

    static std::vector<std::uint32_t> ground(double noise) {
        std::vector<PackedVoxel> voxels;
        const auto height = [](int x, int z) {
            return static_cast<int>(40 + 20 * std::sin(x * 0.05) * std::cos(z * 0.043) +
                                    8 * std::sin(x * 0.21 + z * 0.13));
        };
        for (int z = 0; z < 160; ++z)
            for (int x = 0; x < 160; ++x)
                for (int y = height(x, z) - 8; y < height(x, z); ++y)
                    voxels.push_back({static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y),
                                      static_cast<std::uint16_t>(z), 0});
        const OctreeModel model = buildOctree({.voxels = voxels}, 1, Limits{}).value();
        const FaceIndex index = makeFaceIndex(model, std::vector<Material>(1)).value();
        std::vector<glm::vec3> places(index.faceCount);
        std::vector<unsigned> directions(index.faceCount);
        for (const FaceBrick& brick : index.bricks) {
            std::uint32_t face = brick.firstFace;
            std::uint32_t mask = brick.firstMask;
            for (unsigned direction = 0; direction < 6; ++direction) {
                if ((brick.directions >> direction & 1u) == 0) continue;
                for (std::uint64_t rest = index.masks[mask++]; rest != 0; rest &= rest - 1) {
                    const int k = std::countr_zero(rest);
                    places[face] = glm::vec3(brick.corner() + glm::ivec3(k & 3, k >> 2 & 3, k >> 4));
                    directions[face++] = direction;
                }
            }
        }
        Random random(7);
        const auto bell = [&] {
            double sum = 0;
            for (int i = 0; i < 12; ++i) sum += random.uniform(-0.5, 0.5);
            return sum;
        };
        std::vector<std::uint32_t> values;
        for (const std::uint32_t face : index.fileOrder(0)) {
            const glm::vec3 p = places[face];
            glm::vec3 normal(0.0f);
            normal[static_cast<int>(directions[face] / 2)] = directions[face] % 2 == 0 ? -1.0f : 1.0f;
            glm::dvec3 light = glm::dvec3(0.05, 0.06, 0.08) * (1.2 + 0.8 * static_cast<double>(normal.y));
            for (const glm::vec3 lamp : {glm::vec3(40, 80, 40), glm::vec3(120, 60, 100)}) {
                const glm::vec3 to = lamp - p;
                const double square = static_cast<double>(glm::dot(to, to)) + 16;
                const double cosine =
                    (static_cast<double>(glm::dot(to, normal)) / std::sqrt(square) + 0.4) / 1.4;
                light += glm::dvec3(300, 240, 150) * (std::max(cosine, 0.0) / square);
            }
            light *= 1 + noise * bell();
            for (int c = 0; c < 3; ++c) light[c] *= 1 + 0.4 * noise * bell();
            values.push_back(shared::packRgb9e5(glm::vec3(light)));
        }
        return values;
    }

    static Cost costOf(FaceCodec codec, const std::vector<std::uint32_t>& values) {
        const FaceChunk chunk{.levels = std::vector<std::uint8_t>(values.size(), 0), .values = values};
        const auto packed = faces::packChunk(codec, chunk, {}, ProbeEncodeSettings{}.zstdLevel).value();
        EXPECT_LT(packed.entry.frames.storedBytes[0], 6u) << "levels that are all 0";
        const auto count = static_cast<double>(values.size());
        Cost cost{.bytes = static_cast<double>(packed.stored.size()) / count};
        for (const std::uint32_t value : values) {
            const glm::dvec3 a(shared::unpackRgb9e5(value));
            const glm::dvec3 b(shared::unpackRgb9e5(storedFaceValue(codec, value)));
            cost.light += std::pow((b.x + b.y + b.z) / (a.x + a.y + a.z) - 1, 2) / count;
            for (int c = 0; c < 3; ++c) cost.color += std::pow(b[c] / a[c] - 1, 2) / (3 * count);
        }
        cost.light = std::sqrt(cost.light);
        cost.color = std::sqrt(cost.color);
        return cost;
    }
};

TEST_F(FaceCost, OfSmoothLightWithNoise) {
    for (const double noise : {0.0, 0.005, 0.03}) {
        const auto values = ground(noise);
        for (const FaceCodec codec : {FaceCodec::Quantized, FaceCodec::Lossless}) {
            const Cost cost = costOf(codec, values);
            std::cout << toString(codec) << ", " << values.size() << " values, noise " << 100 * noise
                      << " %: " << cost.bytes << " B a value, " << 100 * cost.light << " % of light, "
                      << 100 * cost.color << " % of color\n";
            if (codec == FaceCodec::Lossless) {
                EXPECT_EQ(cost.color, 0);
                EXPECT_LT(cost.bytes, noise > 0.01 ? 2.3 : 1.9);
            } else {
                EXPECT_LT(cost.light, 0.004);
                EXPECT_LT(cost.color, 0.007);
                EXPECT_LT(cost.bytes, noise > 0.01 ? 1.4 : 1.0);
            }
        }
    }
}

}  // namespace
}  // namespace pfvox
