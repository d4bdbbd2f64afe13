#include "support/image_compare.hpp"

#include <algorithm>
#include <cstdlib>

#include "png.hpp"

namespace pfvox::test {

namespace {

std::uint32_t largestDifference(std::uint32_t a, std::uint32_t b) {
    std::uint32_t largest = 0;
    for (int shift = 0; shift < 32; shift += 8) {
        const std::uint32_t x = a >> shift & 0xffu;
        const std::uint32_t y = b >> shift & 0xffu;
        largest = std::max(largest, x > y ? x - y : y - x);
    }
    return largest;
}

std::filesystem::path goldenFile(const std::string& name) {
    return std::filesystem::path(PFVOX_TESTS_DIR) / "image" / "golden" / (name + ".png");
}

/// Writes a picture beside the other outputs of the tests; says where.
std::string keep(const viewer::Picture& picture, const std::string& fileName) {
    const std::filesystem::path file = std::filesystem::path(PFVOX_TEST_OUTPUT_DIR) / fileName;
    const Result<void> written = viewer::writePng(file, picture);
    return written ? "\n  see " + file.string() : "\n  " + describe(written.error());
}

}  // namespace

ImageDifference differenceOf(const viewer::Picture& actual, const viewer::Picture& golden,
                             std::uint32_t channelTolerance) {
    constexpr std::uint32_t kBlack = 0xff000000u;
    constexpr std::uint32_t kWhite = 0xffffffffu;
    ImageDifference difference{.picture = actual};
    for (std::size_t i = 0; i < actual.pixels.size(); ++i) {
        const std::uint32_t d = largestDifference(actual.pixels[i], golden.pixels[i]);
        difference.largest = std::max(difference.largest, d);
        difference.pixels += d > channelTolerance ? 1 : 0;
        difference.picture.pixels[i] = d > channelTolerance ? kWhite : kBlack;
    }
    return difference;
}

::testing::AssertionResult matchesGolden(const viewer::Picture& actual, const std::string& name,
                                         const ImageTolerance& tolerance) {
    const std::filesystem::path file = goldenFile(name);
    if (std::getenv("PFVOX_UPDATE_GOLDEN") != nullptr) {
        const Result<void> written = viewer::writePng(file, actual);
        return written ? ::testing::AssertionSuccess()
                       : ::testing::AssertionFailure() << describe(written.error());
    }
    const Result<viewer::Picture> golden = viewer::readPng(file);
    if (!golden) {
        return ::testing::AssertionFailure()
               << describe(golden.error()) << keep(actual, name + ".actual.png");
    }
    if (golden->width != actual.width || golden->height != actual.height) {
        return ::testing::AssertionFailure()
               << file << " has another size" << keep(actual, name + ".actual.png");
    }
    const ImageDifference difference = differenceOf(actual, *golden, tolerance.channel);
    const double fraction =
        static_cast<double>(difference.pixels) / static_cast<double>(actual.pixels.size());
    if (fraction <= tolerance.pixelFraction) return ::testing::AssertionSuccess();
    return ::testing::AssertionFailure()
           << difference.pixels << " pixels (" << 100.0 * fraction << " %) differ from " << file
           << " by more than " << tolerance.channel << "/255, at most by " << difference.largest
           << keep(actual, name + ".actual.png") << keep(difference.picture, name + ".difference.png");
}

}  // namespace pfvox::test
