// Which tiles go on, and what is said of their noise.
#include "bake/tile_rounds.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace pfvox::test {
namespace {

using bake::moreBatches;
using bake::TileRules;
using shared::TileStatistics;

/// 64 texels of mean 2 whose batches have this variance.
TileStatistics tileOf(std::uint32_t batches, double variance) {
    const double squaredError = batches > 1 ? 64.0 * variance / batches : 0.0;
    return {.mean = 128.0f,
            .squaredError = static_cast<float>(squaredError),
            .surfaceTexels = 64,
            .batches = batches};
}

TEST(TileRounds, WithoutATargetEachTileGetsTheLeast) {
    const TileRules rules{.minBatches = 3, .maxBatches = 9, .noiseTarget = 0.0};
    EXPECT_EQ(moreBatches(tileOf(0, 0.0), rules), 3u);
    EXPECT_EQ(moreBatches(tileOf(3, 100.0), rules), 0u);
}

TEST(TileRounds, TilesThatSeeNothingAreLeftOut) {
    const TileRules rules{.minBatches = 2, .maxBatches = 2};
    const TileStatistics blind{.mean = 0.0f, .squaredError = 0.0f, .surfaceTexels = 0, .batches = 0};
    EXPECT_EQ(moreBatches(blind, rules), 0u);
    const std::array tiles{blind, tileOf(2, 0.0)};
    EXPECT_EQ(bake::summaryOf(tiles, rules).surfaceTexels, 64u);
    EXPECT_EQ(bake::summaryOf(tiles, rules).samples, 64u * 32u);
}

TEST(TileRounds, NoisyTilesGoOnUntilTheyAreQuietOrAtTheEnd) {
    const TileRules rules{.minBatches = 2, .maxBatches = 64, .noiseTarget = 0.004};
    EXPECT_EQ(moreBatches(tileOf(2, 0.0), rules), 0u);
    // Variance 1/3: under the target after 1/3 / 64 / 0.008^2 = 81 batches.
    std::uint32_t batches = 2;
    std::uint32_t rounds = 0;
    for (std::uint32_t more = moreBatches(tileOf(batches, 1.0 / 3.0), rules); more != 0;
         more = moreBatches(tileOf(batches, 1.0 / 3.0), rules), ++rounds)
        batches += more;
    EXPECT_EQ(batches, 64u);
    EXPECT_EQ(rounds, 10u);  // to 3, 4, 6, 9, 13, 19, 28, 42, 63, 64
    TileRules patient = rules;
    patient.maxBatches = 1000;
    EXPECT_NE(moreBatches(tileOf(80, 1.0 / 3.0), patient), 0u);
    EXPECT_EQ(moreBatches(tileOf(82, 1.0 / 3.0), patient), 0u);
}

TEST(TileRounds, TheErrorIsThatOfTheMean) {
    const TileRules rules{.minBatches = 2, .maxBatches = 64, .noiseTarget = 0.004};
    const std::array tiles{tileOf(2, 0.0), tileOf(2, 0.0), tileOf(64, 1.0 / 3.0), tileOf(2, 0.0)};
    const bake::TileSummary summary = bake::summaryOf(tiles, rules);
    EXPECT_NEAR(summary.meanError.value(), 0.25 * std::sqrt(1.0 / 3.0 / 64.0 / 64.0) / 2.0, 1e-7);
    EXPECT_DOUBLE_EQ(summary.noisyTileFraction, 0.25);
    EXPECT_TRUE(std::isinf(bake::relativeError(tileOf(1, 0.0), rules)));
}

/// "noise 0.00 %" of 16 paths.
TEST(TileRounds, OneBatchTellsNoError) {
    const TileRules fixed{.minBatches = 1, .maxBatches = 1};
    const std::array tiles{tileOf(1, 0.0), tileOf(1, 0.0)};
    EXPECT_FALSE(bake::summaryOf(tiles, fixed).meanError);
    EXPECT_EQ(bake::summaryOf(tiles, fixed).noisyTileFraction, 0.0);
    const TileRules adaptive{.minBatches = 1, .maxBatches = 1, .noiseTarget = 0.5};
    EXPECT_EQ(bake::summaryOf(tiles, adaptive).noisyTileFraction, 1.0)
        << "stopped, and nobody knows how noisy";
    const std::array mixed{tileOf(1, 0.0), tileOf(2, 0.0)};
    EXPECT_EQ(bake::summaryOf(mixed, fixed).meanError, 0.0);
}

TEST(TileRounds, DarkTilesAreJudgedByTheFloor) {
    const TileRules rules{.minBatches = 2, .maxBatches = 64, .noiseTarget = 0.02, .noiseFloor = 0.01};
    const TileStatistics dark{.mean = 0.0f, .squaredError = 64.0f * 1e-6f, .surfaceTexels = 64, .batches = 4};
    EXPECT_NEAR(bake::relativeError(dark, rules), 1e-3 / 8.0 / 0.01, 1e-6);
}

}  // namespace
}  // namespace pfvox::test
