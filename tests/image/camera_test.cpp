// The default camera holds the whole scene, whatever its shape.
#include "camera.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace pfvox::test {
namespace {

TEST(Camera, FrameIsRightHandedAndOrthonormal) {
    for (const glm::dvec3 target :
         {glm::dvec3(1, 2, 3), glm::dvec3(0, -5, 0), glm::dvec3(0, 5, 0), glm::dvec3(-1, 0, 0)}) {
        const viewer::CameraFrame f = viewer::frameOf({.position = glm::dvec3(0.0), .target = target});
        EXPECT_NEAR(glm::length(glm::cross(f.right, f.up) + f.forward), 0.0, 1e-12);
        EXPECT_NEAR(glm::length(f.up), 1.0, 1e-12);
        EXPECT_NEAR(glm::dot(glm::normalize(target), f.forward), 1.0, 1e-12);
    }
}

TEST(Camera, FramingHoldsTheWholeBox) {
    for (const glm::dvec3 size :
         {glm::dvec3(1, 1, 1), glm::dvec3(100, 0.1, 3), glm::dvec3(0.1, 80, 0.1), glm::dvec3(2, 1, 500)}) {
        for (const double aspect : {0.5, 1.0, 16.0 / 9.0}) {
            const gpu::WorldBox box{.min = glm::dvec3(-7, 3, 11), .max = glm::dvec3(-7, 3, 11) + size};
            const viewer::ViewCamera camera = viewer::cameraFraming(box, aspect, 40.0);
            const viewer::CameraFrame frame = viewer::frameOf(camera);
            const double tanY = std::tan(glm::radians(20.0));
            for (int i = 0; i < 8; ++i) {
                const glm::dvec3 corner((i & 1) != 0 ? box.max.x : box.min.x,
                                        (i & 2) != 0 ? box.max.y : box.min.y,
                                        (i & 4) != 0 ? box.max.z : box.min.z);
                const glm::dvec3 v = corner - camera.position;
                const double depth = glm::dot(v, frame.forward);
                EXPECT_GT(depth, 0.0);
                EXPECT_LE(std::abs(glm::dot(v, frame.up)), depth * tanY);
                EXPECT_LE(std::abs(glm::dot(v, frame.right)), depth * tanY * aspect);
            }
        }
    }
}

TEST(Camera, FramingLooksFromTheFrontAndAbove) {
    const viewer::ViewCamera camera =
        viewer::cameraFraming({.min = glm::dvec3(0), .max = glm::dvec3(1)}, 1.5, 40.0);
    EXPECT_GT(camera.position.y, camera.target.y);
    EXPECT_GT(camera.position.z, 1.0);
}

}  // namespace
}  // namespace pfvox::test
