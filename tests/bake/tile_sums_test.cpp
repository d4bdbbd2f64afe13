// Which tiles go on, and what comes out of their sums.
#include "bake/tile_sums.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/procedural.hpp"

namespace pfvox::test {
namespace {

using bake::LightItem;
using bake::TileSums;

/// Gives every texel of an item `value`, or values around it.
void addItem(TileSums& sums, const LightItem& item, double value, Random* noise = nullptr) {
    std::vector<glm::vec4> texels(shared::kTileTexels);
    for (glm::vec4& texel : texels)
        texel = glm::vec4(static_cast<float>(16.0 * (value + (noise != nullptr ? noise->uniform(-1.0, 1.0) : 0.0))));
    sums.add(item, texels);
}

TEST(TileSums, WithoutATargetEachTileGetsTheLeast) {
    TileSums sums(16, std::vector<bool>(256, true), {.minBatches = 3, .maxBatches = 9, .noiseTarget = 0.0});
    const auto items = sums.nextRound();
    EXPECT_EQ(items.size(), 4u * 3u);
    for (const LightItem& item : items) addItem(sums, item, 0.5);
    EXPECT_TRUE(sums.nextRound().empty());
    EXPECT_FLOAT_EQ(sums.means()[17].x, 0.5f);
    EXPECT_EQ(sums.samples(), 256u * 48u);
}

TEST(TileSums, TilesThatSeeNothingAreLeftOut) {
    std::vector<bool> sees(256, false);
    sees[3] = true;
    TileSums sums(16, sees, {.minBatches = 2, .maxBatches = 2});
    for (const LightItem& item : sums.nextRound()) {
        EXPECT_EQ(item.tile, 0u);
        addItem(sums, item, 1.0);
    }
    EXPECT_EQ(sums.surfaceTexels(), 1u);
    EXPECT_EQ(sums.means()[4].x, 0.0f);
}

TEST(TileSums, NoisyTilesGoOnAndTheErrorIsTheRightOne) {
    TileSums sums(16, std::vector<bool>(256, true), {.minBatches = 2, .maxBatches = 64, .noiseTarget = 0.004});
    Random random(2);
    std::vector<std::uint32_t> batches(4);
    for (auto items = sums.nextRound(); !items.empty(); items = sums.nextRound()) {
        for (const LightItem& item : items) {
            EXPECT_EQ(item.batch, batches[item.tile]++);
            addItem(sums, item, 2.0, item.tile == 2 ? &random : nullptr);
        }
    }
    EXPECT_EQ(batches[0], 2u);
    // 64 texels of variance 1/3: target 0.008 at 2^0.5 x 0.577 / (8 x 0.008) = 81 batches, more than allowed.
    EXPECT_EQ(batches[2], 64u);
    EXPECT_DOUBLE_EQ(sums.cappedTileShare(), 0.25);
    EXPECT_NEAR(sums.meanError(), 0.25 * std::sqrt(1.0 / 3.0 / 64.0 / 64.0) / 2.0, 2e-4);
}

}  // namespace
}  // namespace pfvox::test
