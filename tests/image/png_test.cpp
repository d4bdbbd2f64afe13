// PNG files: round trip, equal bytes, refusals; and the comparison itself.
#include "png.hpp"

#include <gtest/gtest.h>

#include "support/image_compare.hpp"

namespace pfvox::test {
namespace {

viewer::Picture gradient() {
    viewer::Picture picture{.width = 17, .height = 9, .pixels = {}};
    for (std::uint32_t i = 0; i < 17 * 9; ++i) picture.pixels.push_back(0xff000000u | i * 0x00010307u);
    return picture;
}

TEST(Png, RoundTrip) {
    const viewer::Picture picture = gradient();
    const auto bytes = viewer::encodePng(picture);
    ASSERT_TRUE(bytes);
    const auto back = viewer::decodePng(*bytes);
    ASSERT_TRUE(back) << describe(back.error());
    EXPECT_EQ(back->width, 17u);
    EXPECT_EQ(back->height, 9u);
    EXPECT_EQ(back->pixels, picture.pixels);
    EXPECT_EQ(*viewer::encodePng(picture), *bytes);
}

TEST(Png, EveryPrefixIsRefused) {
    const auto bytes = viewer::encodePng(gradient());
    ASSERT_TRUE(bytes);
    // The last 16 bytes are a checksum and the end mark: every pixel is there before.
    for (std::size_t n = 0; n + 16 < bytes->size(); ++n) {
        EXPECT_FALSE(viewer::decodePng(std::span(*bytes).first(n))) << n;
    }
}

TEST(Png, CannotWriteIntoAFile) {
    const auto written = viewer::writePng("/dev/null/picture.png", gradient());
    ASSERT_FALSE(written);
    EXPECT_EQ(written.error().code, ErrorCode::FileNotWritable);
}

TEST(ImageCompare, CountsPixelsBeyondTheTolerance) {
    const viewer::Picture golden = gradient();
    viewer::Picture actual = golden;
    actual.pixels[3] ^= 0x00000008u;
    actual.pixels[4] ^= 0x00400000u;
    const ImageDifference difference = differenceOf(actual, golden, 8);
    EXPECT_EQ(difference.pixels, 1u);
    EXPECT_EQ(difference.largest, 64u);
    EXPECT_EQ(difference.picture.pixels[4], 0xffffffffu);
    EXPECT_EQ(difference.picture.pixels[3], 0xff000000u);
}

}  // namespace
}  // namespace pfvox::test
