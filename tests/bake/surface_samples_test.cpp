// Where the proximity grid reaches, and that every point of a surface in it belongs to a cell with samples.
#include <gtest/gtest.h>

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "bake/surface_samples.hpp"
#include "bake_fixture.hpp"

namespace pfvox::test {
namespace {

using bake::proximityShape;

WorldBounds boxOf(const glm::dvec3& min, const glm::dvec3& max) {
    return {.min = min, .max = max};
}

TEST(ProximityShape, EndsWithTheSurfacesOrAStepOutsideOfTheProbes) {
    const ProbeGrid probes{.start = {1.0f, 1.0f, 1.0f}, .step = {1.0f, 2.0f, 0.5f}, .counts = {4, 2, 3}};
    // Walls less than a step outside of the probes in x, far away in y, inside of them in z.
    const ProximityGrid shape =
        proximityShape(probes, {8, 4, 5}, boxOf({0.5, -40.0, 1.2}, {4.25, 90.0, 1.8}));
    const glm::vec3 end = shape.start + shape.step * glm::vec3(shape.counts);
    EXPECT_LT(shape.start.x, 0.5f);
    EXPECT_GT(shape.start.x, 0.3f);
    EXPECT_GT(end.x, 4.25f);
    EXPECT_LT(end.x, 4.5f);
    EXPECT_FLOAT_EQ(shape.start.y, -1.0f);
    EXPECT_FLOAT_EQ(end.y, 5.0f);
    EXPECT_GT(shape.start.z, 1.0f);
    EXPECT_LT(end.z, 2.0f);
}

TEST(ProximityShape, OfAGridAwayFromAllSurfacesIsTheSpaceOfItsProbes) {
    const ProbeGrid probes{.start = {0.0f, 0.0f, 0.0f}, .step = {1.0f, 1.0f, 1.0f}, .counts = {2, 2, 2}};
    const ProximityGrid shape = proximityShape(probes, {3, 3, 3}, boxOf({50.0, 0.0, 0.0}, {51.0, 1.0, 1.0}));
    EXPECT_EQ(shape.start, glm::vec3(-1.0f));
    EXPECT_EQ(shape.step, glm::vec3(1.0f));
}

/// A room of 0.1 m voxels in cells that are smaller, turned or not.
void expectSamplesUnderEveryPoint(double radians) {
    const glm::dmat4 turn = glm::rotate(glm::dmat4(1.0), radians, glm::dvec3(0.3, 1.0, 0.2));
    const LoadedScene scene = sceneOf(assetOf(hollowBox({17, 11, 13}), {gray(128)}), Affine(turn));
    const ProbeGrid probes{
        .start = scene.bounds.min, .step = (scene.bounds.max - scene.bounds.min) / 2.0, .counts = {3, 3, 3}};
    const ProximityGrid shape = proximityShape(probes, {29, 19, 23}, scene.bounds);
    const CellSurfaces surfaces =
        sortIntoCells(bake::surfaceSamples(bake::placedModels(scene), shape), shape);
    const Affine world = bake::placedModels(scene).front().worldFromModel;
    std::mt19937 random(7);
    std::uniform_real_distribution<double> fraction(0.0, 1.0);
    std::size_t bare = 0;
    constexpr std::size_t kPoints = 20000;
    for (std::size_t i = 0; i < kPoints; ++i) {
        // On the floor's upper face, seen from within: the plane y = 0 of a box around (0, 0, 0).
        const glm::dvec3 point =
            world * glm::dvec4(17.0 * fraction(random), 0.0, 13.0 * fraction(random), 1.0);
        const glm::vec3 normal(glm::normalize(glm::dmat3(world) * glm::dvec3(0.0, 1.0, 0.0)));
        const auto cell = cellOfSurface(shape, {.position = glm::vec3(point), .normal = normal});
        ASSERT_TRUE(cell.has_value());
        bare += std::ranges::binary_search(surfaces.cells, *cell) ? 0u : 1u;
    }
    EXPECT_LE(bare, kPoints / 400);  // corners of cells that a turned face just touches
}

TEST(SurfaceSamples, LieUnderEveryPointOfASurface) {
    expectSamplesUnderEveryPoint(0.0);
    expectSamplesUnderEveryPoint(0.5);
}

}  // namespace
}  // namespace pfvox::test
