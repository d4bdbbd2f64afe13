// FLIP on pictures whose answer is known or follows from what the metric is.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <pfvox/flip.hpp>

namespace pfvox {
namespace {

constexpr std::uint32_t kEdge = 24;

using Image = std::vector<glm::vec3>;

Image uniform(glm::vec3 color) {
    return Image(kEdge * kEdge, color);
}

std::vector<float> flip(const Image& a, const Image& b) {
    return flipOf({.width = kEdge, .height = kEdge, .reference = a, .test = b});
}

double meanOf(const std::vector<float>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

TEST(Flip, EqualPicturesDoNotDiffer) {
    Image image = uniform({0.2f, 0.5f, 0.7f});
    image[100] = {1, 1, 1};
    for (const float value : flip(image, image)) EXPECT_EQ(value, 0.0f);
}

/// Green and blue are the two colors that the scale ends at.
TEST(Flip, GreenAndBlueDifferMost) {
    EXPECT_NEAR(meanOf(flip(uniform({0, 1, 0}), uniform({0, 0, 1}))), 1.0, 1e-5);
}

/// Lightness 100 apart and no color: from the definition 0.95 + 0.05 (100^0.7 - 0.4 m) / (0.6 m), where m =
/// d^0.7 and d = 203.2 is the distance of green and blue.
TEST(Flip, BlackAndWhite) {
    const double black = meanOf(flip(uniform({0, 0, 0}), uniform({1, 1, 1})));
    EXPECT_NEAR(black, 0.967, 0.002);
    EXPECT_NEAR(black, meanOf(flip(uniform({1, 1, 1}), uniform({0, 0, 0}))), 1e-9);
}

TEST(Flip, MoreDifferenceIsMore) {
    const Image gray = uniform({0.2f, 0.2f, 0.2f});
    double before = 0.0;
    for (const float step : {0.01f, 0.03f, 0.1f, 0.3f}) {
        const double now = meanOf(flip(gray, uniform(glm::vec3{0.2f + step})));
        EXPECT_GT(now, before);
        before = now;
    }
    EXPECT_LT(before, 1.0);
}

/// A checkerboard finer than the eye resolves looks like its mean; one that is coarse does not.
TEST(Flip, WhatIsTooFineIsNotSeen) {
    const auto board = [](std::uint32_t cell) {
        Image image;
        for (std::uint32_t i = 0; i < kEdge * kEdge; ++i)
            image.push_back(glm::vec3{(i % kEdge / cell + i / kEdge / cell) % 2 == 0 ? 0.45f : 0.55f});
        return image;
    };
    const Image gray = uniform(glm::vec3{0.5f});
    const auto difference = [&](std::uint32_t cell, double pixelsPerDegree) {
        const Image image = board(cell);
        return meanOf(flipOf({.width = kEdge,
                              .height = kEdge,
                              .reference = gray,
                              .test = image,
                              .pixelsPerDegree = pixelsPerDegree}));
    };
    EXPECT_LT(difference(1, 120.0), 0.5 * difference(6, 20.0));
}

/// A new edge or point stands out more than the same change spread over a plane.
TEST(Flip, NewFeaturesStandOut) {
    const Image gray = uniform(glm::vec3{0.5f});
    Image point = gray;
    point[kEdge * kEdge / 2 + kEdge / 2] = glm::vec3{1.0f};
    const std::vector<float> values = flip(gray, point);
    EXPECT_GT(*std::max_element(values.begin(), values.end()), 0.2f);
    EXPECT_LT(values[0], 0.01f);
}

}  // namespace
}  // namespace pfvox
