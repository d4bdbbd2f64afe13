// The random numbers: stratified where that is promised, unrelated where it is not.
#include "shared/sampling.glsl.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace pfvox::test {
namespace {

TEST(Sobol, FirstPointsAreThoseOfTheSequence) {
    // Direction numbers of dimension 2: 1/2, 3/4, 5/8, 15/16.
    const double expected[] = {0.0, 0.5, 0.75, 0.25, 0.625, 0.125, 0.375, 0.875};
    for (std::uint32_t i = 0; i < 8; ++i)
        EXPECT_EQ(shared::reversedBits(shared::pascalProduct(i)) * 0x1p-32, expected[i]) << i;
}

TEST(Sobol, EveryElementaryBoxHoldsOnePoint) {
    for (const std::uint32_t key : {1u, 77u, 0xdeadbeefu}) {
        for (const std::uint32_t start : {0u, 256u, 3u * 256u}) {  // each aligned run of 256 by itself
            for (std::uint32_t xBits = 0; xBits <= 8; ++xBits) {
                std::set<std::uint32_t> boxes;
                for (std::uint32_t i = start; i < start + 256; ++i) {
                    const glm::vec2 p = shared::sobolPair(key, i);
                    const auto x = static_cast<std::uint32_t>(p.x * static_cast<float>(1u << xBits));
                    const auto y = static_cast<std::uint32_t>(p.y * static_cast<float>(1u << (8 - xBits)));
                    boxes.insert(x << 16 | y);
                }
                EXPECT_EQ(boxes.size(), 256u) << key << " " << xBits;
            }
        }
    }
}

TEST(Sampling, NumbersStayBelowOne) {
    EXPECT_LT(shared::unitFloat(0xffffffffu), 1.0f);
    EXPECT_EQ(shared::unitFloat(0u), 0.0f);
}

TEST(Sampling, PairsOfDifferentKeysAreUnrelated) {
    double sum = 0.0;
    constexpr int kPairs = 4096;
    for (std::uint32_t i = 0; i < kPairs; ++i) {
        const glm::dvec2 a(shared::sobolPair(shared::texelKey(1, 0, 0, 5), i));
        const glm::dvec2 b(shared::hashPair(shared::texelKey(1, 0, 0, 6), i));
        sum += (a.x - 0.5) * (b.x - 0.5) + (a.y - 0.5) * (b.y - 0.5);
    }
    // Two products of variance 1/144 each a pair.
    EXPECT_LT(std::abs(sum), 4.0 * std::sqrt(2.0 * kPairs / 144.0));
    EXPECT_NE(shared::texelKey(1, 0, 0, 5), shared::texelKey(1, 1, 0, 5));
    EXPECT_NE(shared::texelKey(1, 0, 1, 5), shared::texelKey(1, 0, 0, 5));
}

}  // namespace
}  // namespace pfvox::test
