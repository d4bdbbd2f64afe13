// Where the models of a scene stand, against examples computed by hand; fitted probe grids.
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <pfvox/scene.hpp>

#include "support/scene_assets.hpp"

namespace pfvox::test {
namespace {

using ::testing::IsEmpty;

constexpr double kQuarter = std::numbers::pi / 2.0;

glm::dvec3 apply(const Affine& m, const glm::dvec3& p) {
    return m * glm::dvec4(p, 1.0);
}

void expectNear(const glm::dvec3& a, const glm::dvec3& b, double tolerance = 1e-12) {
    EXPECT_NEAR(a.x, b.x, tolerance);
    EXPECT_NEAR(a.y, b.y, tolerance);
    EXPECT_NEAR(a.z, b.z, tolerance);
}

/// 4 x 3 x 2 voxels of half a metre, from voxel (1, 2, 3): the cube has an edge of 4 voxels.
OctreeAsset handMade() {
    return boxAsset({{1, 2, 3}, {5, 5, 5}}, 0.5);
}

TEST(ScenePlacement, CubeIsTheSmallestPowerOfTwoAroundTheContent) {
    const SourceCube cube = sourceCube(handMade());
    EXPECT_EQ(cube.depth, 2u);
    expectNear(cube.minVoxels, {1.0, 2.0, 3.0});
    EXPECT_EQ(sourceCube(boxAsset({{0, 0, 0}, {1, 1, 1}}, 0.1)).depth, 0u);
    EXPECT_EQ(sourceCube(boxAsset({{0, 0, 0}, {2, 1, 1}}, 0.1)).depth, 1u);
    EXPECT_EQ(sourceCube(boxAsset({{0, 0, 0}, {9, 1, 1}}, 0.1)).depth, 4u);
    EXPECT_EQ(sourceCube(OctreeAsset{}).depth, 0u);
}

TEST(ScenePlacement, CubeHoldsAllVisibleInstances) {
    // Three of them, 2 voxels wide: from -3 to 8 along x, and a hidden one far away.
    OctreeAsset asset =
        boxAsset({{0, 0, 0}, {2, 2, 2}}, 0.1, {{-3, 0, 0}, {1, 5, 0}, {6, 0, 7}, {900, 0, 0}});
    asset.instances[3].hidden = true;
    const SourceCube cube = sourceCube(asset);
    EXPECT_EQ(cube.depth, 4u);
    expectNear(cube.minVoxels, {-3.0, 0.0, 0.0}, 1e-9);
    asset.layers = {{.name = "draft", .hidden = true}};
    asset.instances[3].hidden = false;
    asset.instances[3].layer = 0;
    EXPECT_EQ(sourceCube(asset).depth, 4u) << "on a hidden layer";
    asset.layers[0].hidden = false;
    EXPECT_EQ(sourceCube(asset).depth, 10u);
}

TEST(ScenePlacement, TransformsRoundedToFloatDoNotDoubleTheCube) {
    OctreeAsset asset = boxAsset({{0, 0, 0}, {2, 2, 2}}, 0.1, {{1000, 0, 0}, {1062, 0, 0}});
    for (Instance& instance : asset.instances)
        instance.worldFromModel = Affine(glm::mat4x3(instance.worldFromModel));
    EXPECT_EQ(sourceCube(asset).depth, 6u);
}

// R = Rz Ry Rx by quarter turns takes (x, y, z) to (x, -z, y), then to (y, -z, -x), then to (z, y, -x).
// Corner (0, 0, 0) of the cube is source voxel (1, 2, 3): (1, 2, 3) / 4 -> R (0.75, 0.5, -0.25) -> S (6, 2,
// -0.5) -> T.
TEST(ScenePlacement, CubeByHandWithTurnsAboutAllAxesAndThreeScales) {
    const SceneModel model{.path = "x",
                           .translateMetres = {10.0, 20.0, 30.0},
                           .rotateRadians = {kQuarter, kQuarter, kQuarter},
                           .cubeEdgeMetres = glm::dvec3(8.0, 4.0, 2.0)};
    const OctreeAsset asset = handMade();
    const Affine m = worldFromCube(model, asset);
    expectNear(apply(m, {0.0, 0.0, 0.0}), {16.0, 22.0, 29.5});
    expectNear(apply(m, {1.0, 0.0, 0.0}), {16.0, 22.0, 27.5});
    expectNear(apply(m, {0.0, 1.0, 0.0}), {16.0, 26.0, 29.5});
    expectNear(apply(m, {0.0, 0.0, 1.0}), {24.0, 22.0, 29.5});
    // The same corners as metres of the file: voxel (1, 2, 3) and (5, 2, 3) of half a metre.
    const Affine fromMetres = worldFromAsset(model, asset);
    expectNear(apply(fromMetres, {0.5, 1.0, 1.5}), {16.0, 22.0, 29.5});
    expectNear(apply(fromMetres, {2.5, 1.0, 1.5}), {16.0, 22.0, 27.5});
    // And as voxels of the model, through its instance.
    expectNear(apply(compose(fromMetres, asset.instances[0].worldFromModel), {1.0, 2.0, 3.0}),
               {16.0, 22.0, 29.5});
}

/// Turns the point in the plane of axes a and b, a towards b, by its angle: no matrix involved.
glm::dvec3 turned(glm::dvec3 p, int a, int b, double radians) {
    const double radius = std::hypot(p[a], p[b]);
    const double angle = std::atan2(p[b], p[a]) + radians;
    p[a] = radius * std::cos(angle);
    p[b] = radius * std::sin(angle);
    return p;
}

TEST(ScenePlacement, AnyAngles) {
    const SceneModel model{.path = "x",
                           .translateMetres = {-1.0, 0.25, 7.0},
                           .rotateRadians = {0.3, -1.1, 2.5},
                           .cubeEdgeMetres = glm::dvec3(8.0, -4.0, 0.5)};
    const Affine m = worldFromAsset(model, handMade());
    for (const glm::dvec3 metres : {glm::dvec3(0.5, 1.0, 1.5), glm::dvec3(-3.0, 2.0, 0.1)}) {
        glm::dvec3 p = metres / (0.5 * 4.0);  // in edges of the cube
        p = turned(p, 1, 2, 0.3);
        p = turned(p, 2, 0, -1.1);
        p = turned(p, 0, 1, 2.5);
        expectNear(apply(m, metres), p * glm::dvec3(8.0, -4.0, 0.5) + glm::dvec3(-1.0, 0.25, 7.0));
    }
}

TEST(ScenePlacement, CubeAndMetresAgreeForAFileOfSeveralInstances) {
    const OctreeAsset asset = boxAsset({{0, 0, 0}, {2, 3, 4}}, 0.1, {{-3, 0, 2}, {1, 5, 0}, {6, 0, 7}});
    const SourceCube cube = sourceCube(asset);
    for (const auto& [edges, voxel] :
         {std::pair(std::optional(glm::dvec3(3.0, 1.0, 2.0)), std::optional<double>()),
          std::pair(std::optional<glm::dvec3>(), std::optional(0.25)),
          std::pair(std::optional<glm::dvec3>(), std::optional<double>())}) {
        const SceneModel model{.path = "x",
                               .translateMetres = {1.0, 2.0, 3.0},
                               .rotateRadians = {0.3, 0.4, 0.5},
                               .cubeEdgeMetres = edges,
                               .metresPerVoxel = voxel};
        for (const glm::dvec3 inCube : {glm::dvec3(0.0), glm::dvec3(1.0), glm::dvec3(0.25, 0.5, 0.75)}) {
            const glm::dvec3 metres = 0.1 * (cube.minVoxels + cube.edgeVoxels() * inCube);
            expectNear(apply(worldFromCube(model, asset), inCube),
                       apply(worldFromAsset(model, asset), metres), 1e-9);
        }
    }
}

TEST(ScenePlacement, MetresPerVoxelAndTheFilesOwnVoxelSize) {
    const OctreeAsset asset = handMade();
    SceneModel model{.path = "x"};
    EXPECT_EQ(worldFromAsset(model, asset), identityAffine());
    model.metresPerVoxel = 2.0;
    expectNear(apply(worldFromAsset(model, asset), {0.5, 1.0, 1.5}), {2.0, 4.0, 6.0});
    model.metresPerVoxel = std::nullopt;
    model.cubeEdgeMetres = glm::dvec3(8.0);
    expectNear(apply(worldFromAsset(model, asset), {0.5, 1.0, 1.5}), {2.0, 4.0, 6.0});
}

// ---- Bounds and probe grids -------------------------------------------------------------------------------

TEST(ScenePlacement, BoundsAreThoseOfThePlacedContent) {
    SceneModel model{.path = "x", .translateMetres = {10.0, 0.0, 0.0}, .rotateRadians = {0.0, 0.0, kQuarter}};
    const WorldBounds bounds = boundsOf(handMade(), worldFromAsset(model, handMade()));
    expectNear(bounds.min, {10.0 - 2.5, 0.5, 1.5});
    expectNear(bounds.max, {10.0 - 1.0, 2.5, 2.5});
    EXPECT_TRUE(boundsOf(OctreeAsset{}).empty());
}

ProbeGrid fitted(const ProbeGridRequest& request, const WorldBounds& bounds) {
    DiagnosticList diagnostics;
    const auto grid = fitProbeGrid(request, bounds, diagnostics);
    EXPECT_TRUE(grid) << describe(grid.error());
    EXPECT_THAT(diagnostics.entries(), IsEmpty()) << "encloses";
    return grid.value_or(ProbeGrid{});
}

const WorldBounds kBox{.min = {-2.0, 0.0, 1.0}, .max = {6.0, 3.0, 5.0}};

TEST(ProbeGridFit, NothingGiven) {
    const ProbeGrid grid = fitted({}, kBox);
    expectNear(grid.step, {1.0, 1.0, 1.0});
    EXPECT_EQ(grid.counts, glm::uvec3(9, 4, 5));
    expectNear(grid.start, kBox.min);
}

TEST(ProbeGridFit, StepGivenIsCenterd) {
    const ProbeGrid grid = fitted({.stepMetres = glm::dvec3(3.0, 2.0, 4.0)}, kBox);
    EXPECT_EQ(grid.counts, glm::uvec3(4, 3, 2));
    expectNear(grid.start, {-2.5, -0.5, 1.0});
}

TEST(ProbeGridFit, PositionAndStepGiven) {
    const ProbeGrid grid =
        fitted({.position = glm::dvec3(-3.0, -1.0, 1.0), .stepMetres = glm::dvec3(1.5)}, kBox);
    EXPECT_EQ(grid.counts, glm::uvec3(7, 4, 4));
    expectNear(grid.start, {-3.0, -1.0, 1.0});
}

TEST(ProbeGridFit, CountGiven) {
    const ProbeGrid grid = fitted({.count = glm::uvec3(5, 2, 3)}, kBox);
    expectNear(grid.step, {2.0, 3.0, 2.0});
    expectNear(grid.start, kBox.min);
    EXPECT_EQ(fitted({.position = kBox.min, .count = glm::uvec3(5, 2, 3)}, kBox).step, grid.step);
}

TEST(ProbeGridFit, EmptyAndFlatScenesHaveAGrid) {
    EXPECT_EQ(fitted({}, {}).counts, glm::uvec3(1));
    const ProbeGrid flat = fitted({}, {.min = {0.0, 0.0, 0.0}, .max = {8.0, 0.0, 8.0}});
    EXPECT_EQ(flat.counts, glm::uvec3(9, 1, 9));
    EXPECT_EQ(fitted({}, {.min = {1.0, 1.0, 1.0}, .max = {1.0, 1.0, 1.0}}).counts, glm::uvec3(1));
}

TEST(ProbeGridFit, GridThatDoesNotEncloseIsNotedUnlessAllOfItWasGiven) {
    DiagnosticList diagnostics;
    ProbeGridRequest request{
        .position = glm::dvec3(0.0), .stepMetres = glm::dvec3(1.0), .count = glm::uvec3(2, 2, 2)};
    const auto grid = fitProbeGrid(request, kBox, diagnostics);
    ASSERT_TRUE(grid);
    EXPECT_EQ(grid->start, glm::vec3(0.0f));
    EXPECT_EQ(grid->counts, glm::uvec3(2));
    EXPECT_THAT(diagnostics.entries(), IsEmpty());
    request.count = std::nullopt;
    ASSERT_TRUE(fitProbeGrid(request, kBox, diagnostics));
    ASSERT_EQ(diagnostics.entries().size(), 1u);
    EXPECT_EQ(diagnostics.entries()[0].id, "scene-grid-smaller");
    EXPECT_EQ(diagnostics.entries()[0].severity, Severity::Note);
}

TEST(ProbeGridFit, StepsThatAreTooSmallAreRefused) {
    DiagnosticList diagnostics;
    const auto grid = fitProbeGrid({.stepMetres = glm::dvec3(1e-6)}, kBox, diagnostics);
    ASSERT_FALSE(grid);
    EXPECT_EQ(grid.error().code, ErrorCode::LimitExceeded);
    EXPECT_THAT(grid.error().message, ::testing::HasSubstr("raise probeGridStep"));
}

TEST(ScenePlacement, TheOriginMovesOnlyFarAway) {
    const auto at = [](double x, double size) {
        return frameOrigin({.min = {x, 0, 0}, .max = {x + size, size, size}});
    };
    EXPECT_EQ(frameOrigin({}), glm::dvec3(0.0));
    EXPECT_EQ(at(900.0, 10.0), glm::dvec3(0.0)) << "near";
    EXPECT_EQ(at(1500.0, 1000.0), glm::dvec3(0.0)) << "as large as far away";
    EXPECT_EQ(at(5.2e6, 10.0), glm::dvec3(256.0 * 20313, 0, 0)) << "a multiple of 256 m";
    DiagnosticList diagnostics;
    const WorldBounds far{.min = {5.2e6, 0, 0}, .max = {5.2e6 + 16, 8, 8}};
    const auto grid = fitProbeGrid({}, far, diagnostics);
    ASSERT_TRUE(grid);
    EXPECT_EQ(grid->worldOf(grid->pointOf(1)) - grid->worldOf(grid->pointOf(0)), glm::dvec3(2, 0, 0));
    EXPECT_LE(glm::length(grid->start), 129.0f);
}

}  // namespace
}  // namespace pfvox::test
