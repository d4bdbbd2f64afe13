// Pictures against golden pictures, with a tolerance.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <string>

#include "picture.hpp"

namespace pfvox::test {

/// Devices round differently, and a hit at an edge may fall to either side: single pixels may differ, areas
/// may not.
struct ImageTolerance {
    std::uint32_t channel = 8;     ///< a pixel differs when a channel does by more than this, of 255
    double pixelFraction = 0.005;  ///< fraction of the pixels that may differ
};

struct ImageDifference {
    std::uint64_t pixels = 0;   ///< that differ
    std::uint32_t largest = 0;  ///< largest difference of a channel
    viewer::Picture picture;    ///< where: white on black
};

/// Both pictures have the same size.
ImageDifference differenceOf(const viewer::Picture& actual, const viewer::Picture& golden,
                             std::uint32_t channelTolerance);

/// Compares with tests/image/golden/<name>.png. When they differ, <name>.actual.png and <name>.difference.png
/// are written to the folder of test outputs in the build tree. With PFVOX_UPDATE_GOLDEN set in the
/// environment the golden picture is written instead.
::testing::AssertionResult matchesGolden(const viewer::Picture& actual, const std::string& name,
                                         const ImageTolerance& tolerance = {});

}  // namespace pfvox::test
