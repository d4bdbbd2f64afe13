// What is drawn upon the picture and dragged in it: projection, handles, and what they do to a model.
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "compose/gizmo.hpp"
#include "compose/model_drag.hpp"
#include "compose/model_edits.hpp"
#include "pick.hpp"
#include "support/procedural.hpp"

namespace pfvox::test {
namespace {

using namespace viewer;

constexpr glm::dvec2 kWindow{800.0, 600.0};
constexpr ViewCamera kCamera{.position = {3, 4, 9}, .target = {0.5, 0, -1}, .fovYDegrees = 50};

double distance(const glm::dvec3& a, const glm::dvec3& b) {
    return glm::length(a - b);
}

TEST(Projection, PointsAndRaysAreInverse) {
    const Projection projection(kCamera, kWindow);
    Random random(3);
    int seen = 0;
    for (int i = 0; i < 1000; ++i) {
        const glm::dvec3 world(random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(-9, 12));
        const auto point = projection.pointOf(world);
        EXPECT_EQ(point.has_value(), projection.depthOf(world) > 1e-4);
        if (!point) continue;
        ++seen;
        const WorldRay ray = projection.rayAt(*point);
        const double along = glm::dot(world - ray.origin, ray.direction);
        EXPECT_LT(distance(ray.origin + along * ray.direction, world), 1e-9);
    }
    EXPECT_GT(seen, 500);
}

TEST(Projection, AgreesWithTheRaysOfPicking) {
    const Projection projection(kCamera, kWindow);
    for (const glm::dvec2 parts : {glm::dvec2(0.1, 0.2), glm::dvec2(0.5, 0.5), glm::dvec2(0.95, 0.7)}) {
        const gpu::GpuRay ray = rayThrough(kCamera, parts, kWindow.x / kWindow.y);
        EXPECT_LT(distance(projection.rayAt(parts * kWindow).direction, glm::dvec3(ray.direction)), 1e-6);
    }
}

TEST(Projection, LinesEndInFrontOfTheCamera) {
    const Projection projection({.position = {0, 0, 0}, .target = {0, 0, -1}, .fovYDegrees = 90}, kWindow);
    EXPECT_FALSE(projection.lineOf({0, 0, 1}, {5, 0, 2}));
    const auto whole = projection.lineOf({-1, 0, -2}, {1, 0, -2});
    ASSERT_TRUE(whole);
    EXPECT_NEAR(whole->first.x, 250.0, 1e-9);
    EXPECT_NEAR(whole->second.x, 550.0, 1e-9);
    const auto half = projection.lineOf({0, 1, -2}, {0, 1, 5});
    ASSERT_TRUE(half);
    EXPECT_NEAR(half->first.y, 150.0, 1e-9);
    EXPECT_LT(half->second.y, -1000.0);
    EXPECT_TRUE(std::isfinite(half->second.y));
}

TEST(Gizmo, ArrowsAreFoundAtTheirTipsAndNothingFarAway) {
    const Projection projection(kCamera, kWindow);
    const Gizmo gizmo(projection, {0, 0, 0});
    ASSERT_TRUE(gizmo.isSeen());
    for (const Handle handle : {Handle::X, Handle::Y, Handle::Z}) {
        const auto tip = projection.pointOf(gizmo.tipOf(handle));
        ASSERT_TRUE(tip);
        EXPECT_EQ(gizmo.handleAt(*tip), handle);
    }
    const auto square = projection.pointOf(0.6 * gizmo.tipOf(Handle::Ground));
    EXPECT_EQ(gizmo.handleAt(*square), Handle::Ground);
    EXPECT_EQ(gizmo.handleAt(*projection.pointOf(gizmo.circleAt(2.4))), Handle::Turn);
    EXPECT_FALSE(gizmo.handleAt({10, 10}));
    EXPECT_FALSE(Gizmo(projection, {30, 40, 90}).isSeen()) << "behind the camera";
    EXPECT_FALSE(Gizmo(projection, {30, 40, 90}).handleAt({400, 300}));
}

TEST(Gizmo, ADragAlongAnAxisFollowsTheCursor) {
    const Projection projection(kCamera, kWindow);
    const glm::dvec3 origin(0.5, -1.0, 0.25);
    const Gizmo gizmo(projection, origin);
    const auto at = [&](const glm::dvec3& p) { return *projection.pointOf(p); };
    EXPECT_LT(distance(gizmo.moved(Handle::X, at(origin), at(origin + glm::dvec3(1.5, 0, 0))), {1.5, 0, 0}),
              1e-9);
    EXPECT_LT(distance(gizmo.moved(Handle::Y, at(origin), at(origin + glm::dvec3(0, -0.7, 0))), {0, -0.7, 0}),
              1e-9);
    EXPECT_LT(distance(gizmo.moved(Handle::Z, at(origin), at(origin + glm::dvec3(0, 0, 2))), {0, 0, 2}),
              1e-9);
    EXPECT_LT(distance(gizmo.moved(Handle::Ground, at(origin), at(origin + glm::dvec3(1, 0, 2))), {1, 0, 2}),
              1e-9);
    EXPECT_EQ(gizmo.moved(Handle::Ground, at(origin), {400, -5000}), glm::dvec3(0)) << "above the horizon";
    EXPECT_NEAR(gizmo.turned(at(gizmo.circleAt(0.2)), at(gizmo.circleAt(1.0))), 0.8, 1e-9);
    EXPECT_NEAR(gizmo.turned(at(gizmo.circleAt(3.0)), at(gizmo.circleAt(-3.0))), 2 * std::numbers::pi - 6.0,
                1e-9);
}

TEST(Gizmo, AnAxisSeenEndOnIsNotDragged) {
    const Projection projection({.position = {0, 0, 5}, .target = {0, 0, 0}}, kWindow);
    const Gizmo gizmo(projection, {0, 0, 0});
    EXPECT_EQ(gizmo.moved(Handle::Z, {400, 300}, {401, 300}), glm::dvec3(0));
    EXPECT_EQ(gizmo.moved(Handle::Ground, {400, 300}, {401, 301}), glm::dvec3(0))
        << "the ground seen edge-on";
}

/// Where the model takes a point of its file.
glm::dvec3 placed(const SceneModel& model, const OctreeAsset& asset, const glm::dvec3& point) {
    return worldFromAsset(model, asset) * glm::dvec4(point, 1.0);
}

TEST(ModelEdits, TurningKeepsTheCenterAndTurnsAllElse) {
    const OctreeAsset asset = build(demoRoom());
    Random random(5);
    for (int i = 0; i < 200; ++i) {
        SceneModel model{.path = "x", .translateMetres = {random.uniform(-5, 5), 1, random.uniform(-5, 5)}};
        model.rotateRadians = {random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(-3, 3)};
        if (i % 4 == 0) model.rotateRadians.y = 0.5 * std::numbers::pi;
        if (i % 2 == 0) model.metresPerVoxel = 0.37;
        const glm::dvec3 center(1.0, 2.0, 3.0);
        const double angle = random.uniform(-7, 7);
        const SceneModel turned = turnedAbout(model, center, angle);
        for (const glm::dvec3 point : {glm::dvec3(0), glm::dvec3(1, 2, 3), glm::dvec3(6, 0, 2)}) {
            const glm::dvec3 before = placed(model, asset, point) - center;
            const glm::dvec3 expected(std::cos(angle) * before.x + std::sin(angle) * before.z, before.y,
                                      -std::sin(angle) * before.x + std::cos(angle) * before.z);
            EXPECT_LT(distance(placed(turned, asset, point) - center, expected), 1e-8) << i;
        }
    }
}

TEST(ModelEdits, AnAngleAboutTheVerticalStaysReadable) {
    glm::dvec3 angles(0.0);
    for (int i = 0; i < 6; ++i) angles = turnedAngles(angles, glm::radians(15.0));
    EXPECT_EQ(angles.x, 0.0);
    EXPECT_NEAR(angles.y, 0.5 * std::numbers::pi, 1e-12);
    EXPECT_EQ(angles.z, 0.0);
    for (int i = 0; i < 6; ++i) angles = turnedAngles(angles, glm::radians(15.0));
    EXPECT_NEAR(std::abs(angles.y), std::numbers::pi, 1e-9);
}

TEST(ModelEdits, ResizingKeepsTheFoot) {
    const OctreeAsset asset = build(demoRoom());
    const double voxel = asset.source.voxelSizeMetres;
    SceneModel model{.path = "x", .translateMetres = {1, 2, 3}, .rotateRadians = {0.3, 0.2, 0.1}};
    for (const bool byCube : {false, true}) {
        if (byCube) model.cubeEdgeMetres = glm::dvec3(8, 4, 2);
        const glm::dvec3 foot = footOf(boundsOf(asset, worldFromAsset(model, asset)));
        const SceneModel larger = resized(model, {.factor = 1.5, .center = foot, .voxelMetres = voxel});
        const WorldBounds before = boundsOf(asset, worldFromAsset(model, asset));
        const WorldBounds after = boundsOf(asset, worldFromAsset(larger, asset));
        EXPECT_LT(distance(footOf(after), foot), 1e-9);
        EXPECT_LT(distance(after.max - after.min, 1.5 * (before.max - before.min)), 1e-9);
    }
}

TEST(ModelDrag, ADragIsOneStepFromWhereItBegan) {
    SceneEditor editor;
    Scene scene;
    scene.models = {{.path = "a.pf_vox", .translateMetres = {1, 0, 0}}};
    editor.reset(scene, {}, "/");
    editor.select(0);
    const Projection projection(kCamera, kWindow);
    const Gizmo gizmo(projection, {0, 0, 0});
    const auto at = [&](const glm::dvec3& p) { return *projection.pointOf(p); };
    const ModelDrag drag(editor, gizmo, Handle::X, at({0, 0, 0}));
    for (const double x : {0.5, 2.0, 1.5}) ASSERT_TRUE(drag.moveTo(at({x, 0, 0}), editor));
    EXPECT_LT(distance(editor.scene().models[0].translateMetres, {2.5, 0, 0}), 1e-9);
    EXPECT_EQ(editor.undoText(), "move 'a.pf_vox'");
    ASSERT_TRUE(editor.undo());
    EXPECT_FALSE(editor.isChanged());
    EXPECT_FALSE(editor.canUndo());
}

TEST(ComposeGeometry, GridsAreWrittenInTheFewestDigits) {
    const ProbeGrid grid{.start = glm::vec3(-3.6f, 0.1f, 0.0f), .step = glm::vec3(0.7f), .counts = {2, 3, 4}};
    const ProbeGridRequest request = requestOf(grid, glm::uvec3(64));
    EXPECT_EQ(request.position, glm::dvec3(-3.6, 0.1, 0.0));
    EXPECT_EQ(request.stepMetres, glm::dvec3(0.7));
    EXPECT_EQ(request.count, glm::uvec3(2, 3, 4));
}

}  // namespace
}  // namespace pfvox::test
