// Light on faces whose value is known: furnaces, form factors, walls of one voxel, several instances.
#include <cmath>
#include <iostream>
#include <numbers>

#include "bake_fixture.hpp"
#include "faces/face_lists.hpp"
#include "faces/face_tracer.hpp"

namespace pfvox::test {
namespace {

struct LitFaces {
    std::vector<shared::FaceRecord> records;
    bake::TracedFaces faces;
    std::uint64_t rays = 0;

    /// Mean of a face's values.
    double lightOf(std::size_t face) const {
        glm::dvec3 sum(0.0);
        const std::uint64_t first = faces.firstValue[face];
        const std::uint64_t end = faces.firstValue[face + 1];
        for (std::uint64_t i = first; i < end; ++i)
            sum += glm::dvec3(shared::unpackRgb9e5(faces.light.values[i]));
        return (sum.x + sum.y + sum.z) / (3.0 * static_cast<double>(end - first));
    }
    bool hasValue(std::size_t face) const { return faces.light.levels[face] != kNoFaceValue; }
};

class FaceLightTest : public BakeTest {
  protected:
    static BakeSettings plain(std::uint32_t rays) {
        BakeSettings settings;
        settings.faces = FaceSettings{
            .baseRays = 256, .minRays = rays, .maxRays = rays, .noiseTarget = 0.005f, .divide = false};
        return settings;
    }
    /// Voxels from the lowest one on.
    static std::vector<shared::FaceRecord> fromTheirCorner(std::vector<shared::FaceRecord> records) {
        glm::uvec3 low(~0u);
        for (const shared::FaceRecord& r : records) low = glm::min(low, glm::uvec3(r.x, r.y, r.z));
        for (shared::FaceRecord& r : records) {
            r.x -= low.x;
            r.y -= low.y;
            r.z -= low.z;
        }
        return records;
    }
    static LitFaces bakeFaces(const LoadedScene& scene, const BakeSettings& settings) {
        LitFaces lit;
        const auto baked = [&]() -> Result<void> {
            DiagnosticList unused;
            const bake::EmitterList emitters = bake::makeEmitters(bake::placedModels(scene));
            PFVOX_TRY(const gpu::Scene, gpuScene,
                      gpu::Scene::build(device(), gpu::partsOf(scene), unused, {.faces = true}));
            lit.records = fromTheirCorner(bake::listFaces(gpuScene).records);
            PFVOX_TRY(bake::FaceTracer, tracer,
                      bake::FaceTracer::create(device(), gpuScene, scene.scene.sun, scene.scene.sky, emitters,
                                               settings));
            PFVOX_TRY(bake::TracedFaces, faces, tracer.run([&](const BakePass& pass) -> Result<void> {
                lit.rays += pass.rays;
                return {};
            }));
            PFVOX_TRY(const std::uint64_t, lost, tracer.stepLimitRays());
            EXPECT_EQ(lost, 0u);
            lit.faces = std::move(faces);
            return {};
        }();
        EXPECT_TRUE(baked) << (baked ? "" : describe(baked.error()));
        EXPECT_EQ(device().validationMessages(), std::vector<std::string>{});
        return lit;
    }
    /// All values of faces for which `counts` says yes are `expected`, but for a fraction.
    template <class Counts>
    static void expectLight(const LitFaces& lit, double expected, double tolerance, const Counts& counts) {
        std::size_t faces = 0;
        double worst = 0.0;
        double sum = 0.0;
        for (std::size_t i = 0; i < lit.records.size(); ++i) {
            if (!counts(lit.records[i])) continue;
            ASSERT_TRUE(lit.hasValue(i));
            ++faces;
            sum += lit.lightOf(i);
            worst = std::max(worst, std::abs(lit.lightOf(i) / expected - 1.0));
        }
        ASSERT_NE(faces, 0u);
        std::cout << "  " << faces << " faces, mean " << sum / static_cast<double>(faces) << " of "
                  << expected << ", worst " << worst << ", sweeps " << lit.faces.sweeps << ", noise "
                  << lit.faces.meanNoise << ", rays " << lit.rays << "\n";
        EXPECT_NEAR(sum / static_cast<double>(faces) / expected, 1.0, 0.5 * tolerance);
        EXPECT_LT(worst, tolerance);
    }
};

/// Of a hollow box of `edge` inner voxels: faces that look inside.
struct Inside {
    std::uint32_t edge = 10;
    bool operator()(const shared::FaceRecord& r) const {
        const std::uint32_t face = r.instanceAndFace & 7u;
        const std::array<std::uint32_t, 3> at{r.x, r.y, r.z};
        const std::uint32_t along = at[face / 2];
        if (face % 2 != 0 ? along != 0 : along != edge + 1) return false;
        for (std::uint32_t axis = 0; axis < 3; ++axis)
            if (axis != face / 2 && (at[axis] == 0 || at[axis] == edge + 1)) return false;
        return true;
    }
};

TEST_F(FaceLightTest, AFurnaceHasTheLightOfItsSeries) {
    for (const std::uint8_t byte : {std::uint8_t{188}, std::uint8_t{243}}) {
        const double rho = linearOf(byte);
        const LoadedScene scene = sceneOf(assetOf(hollowBox(glm::ivec3(10)), {gray(byte, 0.5)}));
        const LitFaces lit = bakeFaces(scene, plain(512));
        expectLight(lit, 0.5 / (1.0 - rho), 0.02, Inside{});
    }
}

TEST_F(FaceLightTest, ATurnedAndStretchedFurnaceIsTheSame) {
    const double a = 30.0 * std::numbers::pi / 180.0;
    const glm::dmat3 turn{{std::cos(a), 0.0, -std::sin(a)}, {0.0, 1.0, 0.0}, {std::sin(a), 0.0, std::cos(a)}};
    const glm::dmat3 stretch{{2.0, 0.0, 0.0}, {0.0, 0.5, 0.0}, {0.0, 0.0, 1.3}};
    for (const glm::dmat3& m :
         {stretch * turn, turn * glm::dmat3{{-1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}}) {
        const Affine world{m[0], m[1], m[2], glm::dvec3(3.0, -2.0, 5.0)};
        const LoadedScene scene = sceneOf(assetOf(hollowBox(glm::ivec3(6)), {gray(188, 1.0)}), world);
        expectLight(bakeFaces(scene, plain(256)), 1.0 / (1.0 - linearOf(188)), 0.04, Inside{.edge = 6});
    }
}

TEST_F(FaceLightTest, UnderAnEvenSkyAFreeFaceHasAll) {
    VoxelModel model;
    model.set({0, 0, 0}, 0);
    LoadedScene scene = sceneOf(assetOf(std::move(model), {gray(188)}));
    scene.scene.sky = {.zenith = glm::dvec3(2.0), .horizon = glm::dvec3(2.0), .ground = glm::dvec3(2.0)};
    const LitFaces lit = bakeFaces(scene, plain(256));
    EXPECT_EQ(lit.records.size(), 6u);
    expectLight(lit, 2.0, 0.005, [](const shared::FaceRecord&) { return true; });
}

TEST_F(FaceLightTest, WallsOfOneVoxelDoNotLeak) {
    // Two rooms, a lamp in one of them.
    VoxelModel model = hollowBox(glm::ivec3(13, 6, 6));
    for (int y = 0; y < 6; ++y)
        for (int z = 0; z < 6; ++z) model.set({6, y, z}, 0);
    model.set({2, 6, 2}, 1);
    BakeSettings settings = plain(256);
    settings.faces->divide = true;
    const LitFaces lit =
        bakeFaces(sceneOf(assetOf(std::move(model), {gray(200), gray(120, 20.0)})), settings);
    double dark = 0.0;
    double bright = 0.0;
    for (std::size_t i = 0; i < lit.records.size(); ++i) {
        const shared::FaceRecord& r = lit.records[i];
        const bool inside = r.y > 0 && r.y < 7 && r.z > 0 && r.z < 7;
        if (!inside || (r.instanceAndFace & 7u) / 2 != 0) continue;
        if (r.x == 7 && (r.instanceAndFace & 1u) == 0) bright = std::max(bright, lit.lightOf(i));
        if (r.x == 7 && (r.instanceAndFace & 1u) != 0) dark = std::max(dark, lit.lightOf(i));
    }
    EXPECT_GT(bright, 0.05);
    EXPECT_EQ(dark, 0.0);
}

TEST_F(FaceLightTest, WhatAnotherInstanceCoversHasNoValue) {
    // Two cubes that share a corner cell: of the faces within the other one nothing can be seen.
    VoxelModel cube;
    fillBox(cube, {glm::ivec3(0), glm::ivec3(4)}, [](glm::ivec3) { return std::optional<MaterialIndex>(0); });
    VoxelAsset asset = assetOf(std::move(cube), {gray(188)});
    Instance second = asset.instances[0];
    second.worldFromModel[3] = 0.1 * glm::dvec3(2.0, 0.0, 0.0);
    asset.instances.push_back(second);
    LoadedScene scene = sceneOf(std::move(asset));
    scene.scene.sky = {.zenith = glm::dvec3(1.0), .horizon = glm::dvec3(1.0), .ground = glm::dvec3(1.0)};
    const LitFaces lit = bakeFaces(scene, plain(128));
    ASSERT_EQ(lit.records.size(), 2u * 96u);
    std::size_t covered = 0;
    for (std::size_t i = 0; i < lit.records.size(); ++i) {
        if (lit.hasValue(i)) {
            EXPECT_NEAR(lit.lightOf(i), 1.0, 0.01);
        } else {
            ++covered;
        }
    }
    EXPECT_EQ(covered, 2u * 16u);  // the sides that look along x
}

TEST_F(FaceLightTest, BitsDoNotDependOnDispatches) {
    VoxelModel model = hollowBox(glm::ivec3(5, 6, 7));
    model.set({2, 6, 2}, 1);
    const LoadedScene scene = sceneOf(assetOf(std::move(model), {gray(200), gray(120, 20.0)}));
    BakeSettings settings = plain(128);
    settings.faces->divide = true;
    settings.faces->maxRays = 512;
    settings.dispatchSeconds = 10.0;
    const LitFaces whole = bakeFaces(scene, settings);
    settings.dispatchSeconds = 1e-4;
    const LitFaces pieces = bakeFaces(scene, settings);
    EXPECT_EQ(whole.faces.light.levels, pieces.faces.light.levels);
    EXPECT_EQ(whole.faces.light.values, pieces.faces.light.values);
    EXPECT_GT(whole.faces.dividedFaces, 0u);
}

}  // namespace
}  // namespace pfvox::test
