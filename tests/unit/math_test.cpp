#include <gtest/gtest.h>

#include <pfvox/math.hpp>

namespace pfvox {
namespace {

TEST(Morton, SlotIsXPlusTwoYPlusFourZ) {
    EXPECT_EQ(mortonEncode({1, 0, 0}), 1u);
    EXPECT_EQ(mortonEncode({0, 1, 0}), 2u);
    EXPECT_EQ(mortonEncode({0, 0, 1}), 4u);
    EXPECT_EQ(mortonEncode({2, 0, 0}), 8u);
    EXPECT_EQ(mortonEncode({1023, 1023, 1023}), 0x3fffffffu);
}

TEST(Morton, DecodeIsTheInverse) {
    for (std::uint32_t code = 0; code < 1u << 18; ++code) ASSERT_EQ(mortonEncode(mortonDecode(code)), code);
}

TEST(VoxelBox, SizeDoesNotOverflow) {
    const VoxelBox box{{-2'000'000'000, 0, 0}, {2'000'000'000, 1, 1}};
    EXPECT_EQ(box.size(), glm::i64vec3(4'000'000'000, 1, 1));
    EXPECT_TRUE(VoxelBox{}.empty());
    EXPECT_EQ(VoxelBox{}.size(), glm::i64vec3(0));
}

TEST(Affine, ComposeIsAfter) {
    Affine move = identityAffine();
    move[3] = {1, 2, 3};
    Affine scale{2.0};
    const glm::dvec3 p = compose(move, scale) * glm::dvec4(1, 1, 1, 1);
    EXPECT_EQ(p, glm::dvec3(3, 4, 5));
}

}  // namespace
}  // namespace pfvox
