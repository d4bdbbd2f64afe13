// What dragging, the wheel and keys do to the camera.
#include "camera_controller.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace pfvox::test {
namespace {

using viewer::CameraController;
using viewer::CameraMode;

CameraController controllerAt(CameraMode mode) {
    CameraController controller;
    controller.mode = mode;
    controller.set({.position = {3, 2, 9}, .target = {3, 2, -1}});
    return controller;
}

double distanceOf(const viewer::ViewCamera& camera) {
    return glm::length(camera.target - camera.position);
}

TEST(CameraController, OrbitKeepsTargetAndDistance) {
    CameraController controller = controllerAt(CameraMode::Orbit);
    controller.turn({0.3, 0.1});
    EXPECT_EQ(controller.camera().target, glm::dvec3(3, 2, -1));
    EXPECT_NEAR(distanceOf(controller.camera()), 10.0, 1e-9);
    EXPECT_LT(controller.camera().position.x, 3.0) << "dragging to the right turns the scene to the right";
    EXPECT_GT(controller.camera().position.y, 2.0) << "dragging down tips the scene towards the viewer";
}

TEST(CameraController, FlyKeepsThePositionAndLooksWhereDragged) {
    CameraController controller = controllerAt(CameraMode::Fly);
    controller.turn({0.3, -0.1});
    EXPECT_EQ(controller.camera().position, glm::dvec3(3, 2, 9));
    EXPECT_NEAR(distanceOf(controller.camera()), 10.0, 1e-9);
    EXPECT_GT(controller.camera().target.x, 3.0);
    EXPECT_GT(controller.camera().target.y, 2.0);
}

TEST(CameraController, NeverTurnsOverThePoles) {
    for (const CameraMode mode : {CameraMode::Orbit, CameraMode::Fly}) {
        for (const double y : {50.0, -50.0}) {
            CameraController controller = controllerAt(mode);
            for (int i = 0; i < 10; ++i) controller.turn({0.01, y});
            const viewer::CameraFrame frame = viewer::frameOf(controller.camera());
            EXPECT_GT(frame.up.y, 0.0);
            EXPECT_TRUE(std::isfinite(controller.camera().position.x));
        }
    }
}

TEST(CameraController, PanHoldsTheTargetUnderTheCursor) {
    CameraController controller = controllerAt(CameraMode::Orbit);
    controller.pan({0.25, 0.0});
    const double height = 2.0 * 10.0 * std::tan(glm::radians(20.0));
    EXPECT_NEAR(controller.camera().position.x, 3.0 - 0.25 * height, 1e-9);
    EXPECT_NEAR(controller.camera().target.x, 3.0 - 0.25 * height, 1e-9);
    controller.pan({0.0, 0.5});
    EXPECT_NEAR(controller.camera().position.y, 2.0 + 0.5 * height, 1e-9);
}

TEST(CameraController, WheelComesCloserButNeverArrives) {
    CameraController controller = controllerAt(CameraMode::Orbit);
    controller.wheel(2.0);
    EXPECT_NEAR(distanceOf(controller.camera()), 10.0 * 0.85 * 0.85, 1e-9);
    controller.wheel(-2.0);
    EXPECT_NEAR(distanceOf(controller.camera()), 10.0, 1e-9);
    for (int i = 0; i < 100; ++i) controller.wheel(1000.0);
    EXPECT_GT(distanceOf(controller.camera()), 0.0);
    EXPECT_EQ(controller.camera().target, glm::dvec3(3, 2, -1));
}

TEST(CameraController, WheelChangesTheSpeedOfAFlight) {
    CameraController controller = controllerAt(CameraMode::Fly);
    const double before = controller.speed;
    controller.wheel(1.0);
    EXPECT_GT(controller.speed, before);
    EXPECT_NEAR(distanceOf(controller.camera()), 10.0, 1e-12);
}

TEST(CameraController, MovesBySpeedAndTime) {
    CameraController controller = controllerAt(CameraMode::Fly);
    controller.speed = 4.0;
    controller.move({0, 0, 1}, 0.5, false);
    EXPECT_NEAR(controller.camera().position.z, 7.0, 1e-9);
    controller.move({0, 0, -1}, 0.5, true);
    EXPECT_NEAR(controller.camera().position.z, 17.0, 1e-9) << "five times as fast";
    controller.move({1, 0, 1}, 1.0, false);
    EXPECT_NEAR(glm::length(controller.camera().position - glm::dvec3(3, 2, 17)), 4.0, 1e-9)
        << "no faster diagonally";
    const viewer::ViewCamera still = controller.camera();
    controller.move({0, 0, 0}, 1.0, true);
    EXPECT_EQ(controller.camera(), still);
}

TEST(CameraController, FrameShowsTheBoxAndSetsTheSpeed) {
    CameraController controller = controllerAt(CameraMode::Orbit);
    const gpu::WorldBox box{.min = glm::dvec3(100), .max = glm::dvec3(200)};
    controller.frame(box, 1.5);
    EXPECT_EQ(controller.camera(), viewer::cameraFraming(box, 1.5, 40.0));
    EXPECT_NEAR(controller.speed, 0.2 * std::sqrt(3.0) * 100.0, 1e-9);
}

}  // namespace
}  // namespace pfvox::test
