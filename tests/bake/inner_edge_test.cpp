// Light where two faces meet: rays that start there must not start in the other one's voxel.
#include <cmath>
#include <iostream>
#include <pfvox/probe_file.hpp>
#include <pfvox/verify.hpp>

#include "bake/bake_fixture.hpp"
#include "support/temp_folder.hpp"

namespace pfvox::test {
namespace {

/// A black floor below y = 0 and a black wall below x = 0, both along z, under a white sky: I is 0.5 in the
/// edge.
LoadedScene edgeScene(const Affine& world = identityAffine()) {
    VoxelModel model;
    fillBox(model, {glm::ivec3(-1), {16, 16, 40}}, [](glm::ivec3 p) -> std::optional<MaterialIndex> {
        return p.x < 0 || p.y < 0 ? std::optional<MaterialIndex>(MaterialIndex{0}) : std::nullopt;
    });
    LoadedScene scene = sceneOf(assetOf(std::move(model), {gray(0)}), world);
    scene.scene.sky = {.zenith = glm::dvec3(1.0), .horizon = glm::dvec3(1.0), .ground = glm::dvec3(1.0)};
    return scene;
}

class InnerEdge : public BakeTest {
  protected:
    /// I by path tracing along the row of pixels that looks straight into the edge.
    std::vector<double> tracedAlongEdge(const LoadedScene& scene, const glm::dvec3& eye,
                                        const glm::dvec3& target) {
        std::vector<double> light;
        const auto traced = [&]() -> Result<void> {
            BakeObserver observer;
            BakeSettings coarse = plain(16, 16);
            PFVOX_CHECK(bakeProbes(device(), scene, coarse, folder_ / "one.pf_probe", observer, diagnostics));
            PFVOX_TRY(const ProbeFileReader, reader,
                      ProbeFileReader::open(folder_ / "one.pf_probe", Limits{}, diagnostics));
            PFVOX_TRY(const gpu::Scene, gpuScene,
                      gpu::Scene::build(device(), gpu::partsOf(scene), diagnostics));
            PFVOX_TRY(const gpu::GpuProbes, probes,
                      gpu::GpuProbes::upload(device(), reader, {.voxelMetres = 0.1f}));
            PFVOX_TRY(const ProbeVerifier, verifier, ProbeVerifier::create(device()));
            const Camera camera{.name = "edge", .position = eye, .target = target, .fovYDegrees = 1.0};
            PFVOX_TRY(const VerifiedPicture, picture,
                      verifier.render(device(), {scene, gpuScene, camera, &probes},
                                      {.width = 96, .height = 1, .samples = 256}));
            for (const VerifiedPixel& pixel : picture.pixels)
                if (pixel.surface) light.push_back(static_cast<double>(pixel.reference.x));
            return {};
        }();
        EXPECT_TRUE(traced) << describe(traced.error());
        return light;
    }

    static void expectHalf(const std::vector<double>& light) {
        ASSERT_GT(light.size(), 30u);
        const auto [low, high] = std::ranges::minmax(light);
        std::cout << "  " << light.size() << " values, " << low << " to " << high << "\n";
        EXPECT_GT(low, 0.4);
        EXPECT_LT(high, 0.6);
    }

  private:
    TempFolder folder_;
};

TEST_F(InnerEdge, ACameraThatLooksIntoItSeesItsLight) {
    for (const double d : {0.33, 0.73, 1.37})
        expectHalf(tracedAlongEdge(edgeScene(), {d, d, 2.0}, {0.0, 0.0, 2.0}));
}

TEST_F(InnerEdge, InATurnedModelToo) {
    const double a = 0.4;
    Affine world = identityAffine();
    world[0] = {std::cos(a), 0.0, -std::sin(a)};
    world[2] = {std::sin(a), 0.0, std::cos(a)};
    const auto place = [&](double x, double y, double z) {
        return glm::dvec3(world * glm::dvec4(x, y, z, 1.0));
    };
    for (const double d : {0.37, 0.91})
        expectHalf(tracedAlongEdge(edgeScene(world), place(d, d, 2.0), place(0.0, 0.0, 2.0)));
}

TEST_F(InnerEdge, ATexelThatSeesItHasItsLight) {
    constexpr std::uint32_t kEdge =
        64;  // texels on the map's diagonal look straight into the edge from x = y
    std::vector<double> light;
    for (const float d : {0.31f, 0.57f, 0.93f, 1.21f}) {
        const LitProbe probe = lightAt(edgeScene(), {d, d, 2.0f}, plain(kEdge, 256));
        for (std::uint32_t i = 0; i < kEdge / 2; ++i)
            if (probe.seen[i + kEdge * i].metres >= 0.0f)
                light.push_back(static_cast<double>(probe.light[i + kEdge * i].x));
    }
    expectHalf(light);
}

}  // namespace
}  // namespace pfvox::test
