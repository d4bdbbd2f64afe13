// The sRGB curve against values of IEC 61966-2-1 that were computed elsewhere, and back.
#include "shared/color.glsl.h"

#include <gtest/gtest.h>

namespace pfvox {
namespace {

using shared::linearFromSrgb;
using shared::srgbFromLinear;

TEST(SrgbCurve, HasTheStandardsValues) {
    EXPECT_EQ(linearFromSrgb(0.0), 0.0);
    EXPECT_NEAR(linearFromSrgb(1.0 / 255.0), 0.000303527, 1e-9);
    EXPECT_NEAR(linearFromSrgb(0.5), 0.214041140, 1e-8);
    EXPECT_NEAR(linearFromSrgb(188.0 / 255.0), 0.502886, 1e-6);
    EXPECT_NEAR(linearFromSrgb(1.0), 1.0, 1e-12);
    EXPECT_NEAR(srgbFromLinear(0.18), 0.461356, 1e-6);
    EXPECT_NEAR(srgbFromLinear(0.5f), 0.735357f, 1e-6f);
}

TEST(SrgbCurve, GoesBackToEveryByteAndHasNoStepBetweenItsParts) {
    for (int byte = 0; byte < 256; ++byte)
        EXPECT_NEAR(255.0 * srgbFromLinear(linearFromSrgb(byte / 255.0)), byte, 1e-3);
    EXPECT_NEAR(linearFromSrgb(0.04045), linearFromSrgb(0.040451), 1e-6);
    const glm::dvec3 color = linearFromSrgb(glm::dvec3(0.0, 0.5, 1.0));
    EXPECT_EQ(color.y, linearFromSrgb(0.5));
}

}  // namespace
}  // namespace pfvox
