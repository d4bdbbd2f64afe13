// What verify makes of two pictures whose difference is known.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <pfvox/verify.hpp>

namespace pfvox::test {
namespace {

/// 16 x 16 pixels of light 1; the left half by texels, the right half by the eight around, the last row sees
/// nothing.
VerifiedPicture pictureOf(float texelError, float compactError, float noise) {
    VerifiedPicture picture{.width = 16, .height = 16, .pixels = {}};
    for (std::uint32_t i = 0; i < 256; ++i) {
        VerifiedPixel pixel;
        const bool left = i % 16 < 8;
        const float sign = i % 2 == 0 ? 1.0f : -1.0f;
        pixel.surface = i < 240;
        pixel.reference = glm::vec3{1.0f + sign * noise};
        pixel.noise = glm::vec3{noise};
        pixel.lookup = glm::vec3{1.0f + (left ? texelError : compactError)};
        pixel.tier = left ? gpu::ProbeTier::Texels : gpu::ProbeTier::Compact;
        pixel.material = left ? MaterialType::Metal : MaterialType::Diffuse;
        picture.pixels.push_back(pixel);
    }
    return picture;
}

TEST(VerifyScore, PartsAreToldApart) {
    const VerifyScore score = scoreOf(pictureOf(0.1f, -0.3f, 0.0f));
    EXPECT_EQ(score.surfacePixels, 240u);
    EXPECT_EQ(score.withoutValue, 0u);
    EXPECT_NEAR(score.all.relativeRmse, std::sqrt(0.05), 1e-5);
    EXPECT_NEAR(score.all.relativeBias, -0.1, 1e-5);
    EXPECT_NEAR(score.texels().relativeRmse, 0.1, 1e-5);
    EXPECT_NEAR(score.texels().relativeBias, 0.1, 1e-5);
    EXPECT_EQ(score.texels().pixels, 120u);
    EXPECT_NEAR(score.byMaterial[static_cast<std::size_t>(MaterialType::Diffuse)].relativeRmse, 0.3, 1e-5);
    EXPECT_EQ(score.byMaterial[static_cast<std::size_t>(MaterialType::Glass)].pixels, 0u);
    EXPECT_EQ(score.noiseFlip, 0.0);
}

/// The noise of the reference is in RMSE, stands beside it, and is taken off in quadrature.
TEST(VerifyScore, NoiseOfTheReferenceIsTakenOff) {
    const VerifyScore score = scoreOf(pictureOf(0.0f, 0.0f, 0.2f));
    EXPECT_NEAR(score.all.relativeRmse, 0.2, 1e-5);
    EXPECT_NEAR(score.all.relativeNoise, 0.2, 1e-5);
    EXPECT_NEAR(score.all.relativeError, 0.0, 1e-3);
    EXPECT_GT(score.noiseFlip, 0.0);
    const VerifyScore both = scoreOf(pictureOf(0.15f, 0.15f, 0.2f));
    EXPECT_NEAR(both.all.relativeError, 0.15, 1e-5);
}

TEST(VerifyScore, PixelsWithoutValueCountForNothingElse) {
    VerifiedPicture picture = pictureOf(0.1f, 0.1f, 0.0f);
    picture.pixels[0].tier = gpu::ProbeTier::None;
    picture.pixels[1].lookup.x = std::numeric_limits<float>::quiet_NaN();
    const VerifyScore score = scoreOf(picture);
    EXPECT_EQ(score.withoutValue, 2u);
    EXPECT_EQ(score.all.pixels, 238u);
    EXPECT_NEAR(score.all.relativeRmse, 0.1, 1e-5);
}

/// A speck that holds nearly all of the square is in RMSE and not in what is left without the worst pixels.
TEST(VerifyScore, TrimmedRmseLeavesTheWorstPixelsOut) {
    VerifiedPicture picture = pictureOf(0.1f, 0.1f, 0.0f);
    picture.pixels[5].lookup = glm::vec3{101.0f};
    const VerifyScore score = scoreOf(picture);
    EXPECT_GT(score.all.relativeRmse, 6.0);
    EXPECT_NEAR(score.all.relativeTrimmedRmse, 0.1, 1e-5);  // 240 pixels: one is left out
    picture.pixels[6].lookup = glm::vec3{101.0f};
    EXPECT_GT(scoreOf(picture).all.relativeTrimmedRmse, 6.0);
    EXPECT_NEAR(scoreOf(pictureOf(0.1f, -0.3f, 0.0f))
                    .byTier[static_cast<std::size_t>(gpu::ProbeTier::Compact)]
                    .relativeTrimmedRmse,
                0.3, 1e-5);
}

TEST(VerifyScore, PartOfAllIsThatOfTheScore) {
    VerifiedPicture picture = pictureOf(0.1f, -0.3f, 0.2f);
    picture.pixels[0].tier = gpu::ProbeTier::None;
    const VerifyPart all = scoreOf(picture).all;
    const VerifyPart part = partOfAll(picture);
    EXPECT_EQ(part.pixels, all.pixels);
    EXPECT_EQ(part.relativeRmse, all.relativeRmse);
    EXPECT_EQ(part.relativeNoise, all.relativeNoise);
    EXPECT_EQ(part.relativeError, all.relativeError);
}

TEST(ReferenceTarget, AsksForAsManyPathsAsTheNoiseNeeds) {
    const ReferenceTarget target{.noiseOfError = 0.33, .maxSamples = 16384};
    const auto part = [](double noise, double error) {
        VerifyPart p;
        p.relativeNoise = noise;
        p.relativeError = error;
        return p;
    };
    EXPECT_TRUE(target.isReached(part(0.033, 0.1)));
    EXPECT_FALSE(target.isReached(part(0.034, 0.1)));
    EXPECT_EQ(target.nextSamples(part(0.033, 0.1), 1024), 1024u);
    // Twice the noise wanted: four times the paths, and a tenth.
    EXPECT_EQ(target.nextSamples(part(0.066, 0.1), 1000), 4400u);
    EXPECT_EQ(target.nextSamples(part(0.034, 0.1), 1000), 2000u);
    EXPECT_EQ(target.nextSamples(part(1.0, 0.1), 1000), 8000u);
    EXPECT_EQ(target.nextSamples(part(1.0, 0.0), 1000), 8000u);
    EXPECT_EQ(target.nextSamples(part(1.0, 0.1), 10000), 16384u);
    EXPECT_EQ(target.nextSamples(part(1.0, 0.1), 16384), 16384u);
    EXPECT_EQ(target.nextSamples(part(1.0, 0.1), 30000), 30000u);
    EXPECT_EQ(target.nextSamples(part(0.066, 0.1), 3) % 2, 0u);
    // A light that is the same everywhere and known exactly: nothing to wait for.
    EXPECT_TRUE(target.isReached(part(0.0, 0.0)));
}

}  // namespace
}  // namespace pfvox::test
