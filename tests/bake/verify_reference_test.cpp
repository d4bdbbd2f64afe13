// The reference that probes are held against, without probes: emitters found by looking for them and by
// running into them.
#include <cmath>
#include <iostream>
#include <pfvox/probe_file.hpp>
#include <pfvox/verify.hpp>

#include "bake/bake_fixture.hpp"
#include "support/temp_folder.hpp"

namespace pfvox::test {
namespace {

/// I of all pixels that see a surface, mean of channels.
struct Light {
    double mean = 0.0;
    double error = 0.0;  ///< of that mean, from the halves of the samples
    double noise = 0.0;  ///< of one pixel, root mean square
};

class VerifyReference : public BakeTest {
  protected:
    Light lightOf(const LoadedScene& scene, const Camera& camera, const VerifySettings& settings) {
        const auto light = traced(scene, camera, settings);
        EXPECT_TRUE(light) << describe(light.error());
        if (!light) return {};
        std::cout << "  " << light->mean << " +- " << light->error << ", noise of a pixel " << light->noise
                  << "\n";
        return *light;
    }

    void expectEqual(const Light& a, const Light& b) {
        EXPECT_NEAR(a.mean, b.mean, 3.5 * std::hypot(a.error, b.error));
    }

    /// Calls `body` with a verifier and what it looks at.
    template <class Body>
    Result<void> withVerifier(const LoadedScene& scene, const Camera& camera, const Body& body) {
        BakeObserver observer;
        BakeSettings coarse = plain(16, 16);
        coarse.force = true;
        PFVOX_CHECK(bakeProbes(device(), scene, coarse, folder_ / "one.pf_probe", observer, diagnostics));
        PFVOX_TRY(const ProbeFileReader, reader,
                  ProbeFileReader::open(folder_ / "one.pf_probe", Limits{}, diagnostics));
        PFVOX_TRY(const gpu::Scene, gpuScene, gpu::Scene::build(device(), gpu::partsOf(scene), diagnostics));
        PFVOX_TRY(const gpu::GpuProbes, probes,
                  gpu::GpuProbes::upload(device(), reader, {.voxelMetres = 0.1f}));
        PFVOX_TRY(const ProbeVerifier, verifier, ProbeVerifier::create(device()));
        return body(verifier, VerifyInput{scene, gpuScene, camera, &probes});
    }

  private:
    Result<Light> traced(const LoadedScene& scene, const Camera& camera, const VerifySettings& settings) {
        std::optional<Light> light;
        PFVOX_CHECK(withVerifier(
            scene, camera, [&](const ProbeVerifier& verifier, const VerifyInput& input) -> Result<void> {
                PFVOX_TRY(const VerifiedPicture, picture, verifier.render(device(), input, settings));
                light = lightOf(picture);
                return {};
            }));
        return *light;
    }

    static Light lightOf(const VerifiedPicture& picture) {
        Light light;
        double squares = 0.0;
        double pixels = 0.0;
        for (const VerifiedPixel& pixel : picture.pixels) {
            if (!pixel.surface) continue;
            const double noise = (pixel.noise.x + pixel.noise.y + pixel.noise.z) / 3.0;
            light.mean += (pixel.reference.x + pixel.reference.y + pixel.reference.z) / 3.0;
            squares += noise * noise;
            ++pixels;
        }
        light.mean /= pixels;
        light.error = std::sqrt(squares) / pixels;
        light.noise = std::sqrt(squares / pixels);
        return light;
    }

    TempFolder folder_;
};

constexpr VerifySettings kSmall{.width = 24, .height = 16, .samples = 256};

VerifySettings withoutEmitterSampling(std::uint32_t samples) {
    VerifySettings settings = kSmall;
    settings.samples = samples;
    settings.emitterSampling = false;
    return settings;
}

const Camera kCorner{
    .name = "corner", .position = {0.1, 0.5, 0.1}, .target = {0.9, 0.2, 0.8}, .fovYDegrees = 70.0};

/// A room of one metre with a lamp of two voxels in its ceiling.
VoxelModel roomWithLamp() {
    VoxelModel model = hollowBox(glm::ivec3(10));
    fillBox(model, {{3, 10, 3}, {5, 11, 4}}, [](glm::ivec3) { return MaterialIndex{1}; });
    return model;
}

TEST_F(VerifyReference, EmittersFoundEitherWayGiveTheSameLight) {
    const LoadedScene scene = sceneOf(assetOf(roomWithLamp(), {gray(188), gray(255, 20.0)}));
    const Light with = lightOf(scene, kCorner, kSmall);
    const Light without = lightOf(scene, kCorner, withoutEmitterSampling(1024));
    EXPECT_GT(with.mean, 0.05);
    expectEqual(with, without);
    // A quarter of the paths, and less noise than half of theirs would have.
    EXPECT_LT(2.0 * with.noise, without.noise);
}

TEST_F(VerifyReference, SoTheyDoBehindGlassAndOnMetal) {
    VoxelModel model = roomWithLamp();
    fillBox(model, {{0, 7, 0}, {10, 9, 10}}, [](glm::ivec3) { return MaterialIndex{2}; });
    fillBox(model, {{5, 0, 5}, {8, 3, 8}}, [](glm::ivec3) { return MaterialIndex{3}; });
    Material pane;
    pane.type = MaterialType::Glass;
    pane.transparency = 0.8f;
    pane.baseColor = {230, 200, 120, 255};
    Material metal;
    metal.type = MaterialType::Metal;
    metal.metalness = 0.9f;
    metal.roughness = 0.3f;
    const LoadedScene scene = sceneOf(assetOf(std::move(model), {gray(188), gray(255, 20.0), pane, metal}));
    const Light with = lightOf(scene, kCorner, kSmall);
    const Light without = lightOf(scene, kCorner, withoutEmitterSampling(1024));
    EXPECT_GT(with.mean, 0.02);
    expectEqual(with, without);
    EXPECT_LT(with.noise, without.noise);
}

/// A well of 60 cm under a white sky, its upper half open or full of layers of what is glass by name only.
LoadedScene wellScene(int layers) {
    VoxelModel well;
    fillBox(well, {glm::ivec3(-1), {7, 10, 7}}, [](glm::ivec3 p) -> std::optional<MaterialIndex> {
        const bool inside = p.y >= 0 && p.x >= 0 && p.z >= 0 && p.x < 6 && p.z < 6;
        return inside ? std::nullopt : std::optional<MaterialIndex>(MaterialIndex{0});
    });
    Material clear;
    clear.type = MaterialType::Glass;
    clear.baseColor = {255, 255, 255, 255};
    clear.transparency = 1.0f;
    clear.indexOfRefraction = 1.0f;
    VoxelAsset asset = assetOf(std::move(well), {gray(120), clear});
    if (layers > 0) {
        VoxelModel slab;
        fillBox(slab, {glm::ivec3(0), {6, layers, 6}}, [](glm::ivec3) { return MaterialIndex{1}; });
        asset.models.push_back(std::move(slab));
        Affine thin(0.1);
        thin[1][1] = 0.3 / layers;
        thin[3] = {0.0, 0.6, 0.0};
        asset.instances.push_back({.model = 1, .worldFromModel = thin});
    }
    LoadedScene scene = sceneOf(std::move(asset));
    scene.scene.sky = {.zenith = glm::dvec3(1.0), .horizon = glm::dvec3(1.0), .ground = glm::dvec3(1.0)};
    scene.probes.start = {0.3f, 0.3f, 0.3f};
    return scene;
}

TEST_F(VerifyReference, BodiesOfGlassMayBeManyVoxelsThick) {
    const Camera camera{
        .name = "floor", .position = {0.05, 0.4, 0.05}, .target = {0.4, 0.0, 0.4}, .fovYDegrees = 60.0};
    const VerifySettings settings{.width = 16, .height = 8, .samples = 128};
    const Light open = lightOf(wellScene(0), camera, settings);
    EXPECT_GT(open.mean, 0.05);
    for (const int layers : {1, 3, 30}) expectEqual(open, lightOf(wellScene(layers), camera, settings));
}

TEST_F(VerifyReference, GoesOnBitForBitFromWhatWasTraced) {
    const Camera camera{
        .name = "floor", .position = {0.05, 0.4, 0.05}, .target = {0.4, 0.0, 0.4}, .fovYDegrees = 60.0};
    const auto traced = [&](const ProbeVerifier& verifier, const VerifyInput& input) -> Result<void> {
        VerifySettings settings{.width = 16, .height = 8, .samples = 24};
        PFVOX_TRY(const ReferencePicture, whole, verifier.trace(device(), input, settings));
        settings.samples = 7;
        PFVOX_TRY(ReferencePicture, begun, verifier.trace(device(), input, settings));
        EXPECT_EQ(begun.samples, 7u);
        EXPECT_NE(begun.even, whole.even);
        settings.samples = 24;
        PFVOX_TRY(ReferencePicture, grown, verifier.trace(device(), input, settings, std::move(begun)));
        EXPECT_EQ(grown.samples, 24u);
        EXPECT_EQ(grown.even, whole.even);
        EXPECT_EQ(grown.odd, whole.odd);
        settings.samples = 10;
        PFVOX_TRY(const ReferencePicture, kept, verifier.trace(device(), input, settings, std::move(grown)));
        EXPECT_EQ(kept.samples, 24u);
        return {};
    };
    const auto done = withVerifier(wellScene(0), camera, traced);
    ASSERT_TRUE(done) << describe(done.error());
}

}  // namespace
}  // namespace pfvox::test
