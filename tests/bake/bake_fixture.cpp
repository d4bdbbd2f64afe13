#include "bake_fixture.hpp"

#include <cmath>
#include <glm/packing.hpp>

#include "shared/probe_maths.glsl.h"

#include "shared/color.glsl.h"

namespace pfvox::test {

double linearOf(std::uint8_t byte) {
    return shared::linearFromSrgb(byte / 255.0);
}

Material gray(std::uint8_t byte, double radiance) {
    return material(byte, byte, byte, radiance > 0.0 ? static_cast<float>(radiance / linearOf(byte)) : 0.0f);
}

LoadedScene sceneOf(VoxelAsset asset, const Affine& worldFromAsset) {
    LoadedScene scene;
    scene.scene.sun.irradiance = glm::dvec3(0.0);
    scene.scene.sky = {.zenith = glm::dvec3(0.0), .horizon = glm::dvec3(0.0), .ground = glm::dvec3(0.0)};
    scene.scene.probes.proximityCells = glm::uvec3(4);
    auto built = std::make_shared<const OctreeAsset>(build(asset));
    scene.bounds = boundsOf(*built, worldFromAsset);
    scene.parts.push_back({.asset = built, .worldFromAsset = worldFromAsset, .model = 0});
    const glm::vec3 middle(0.5 * (scene.bounds.min + scene.bounds.max));
    scene.probes = {
        .start = middle, .step = glm::vec3(scene.bounds.max - scene.bounds.min), .counts = glm::uvec3(1)};
    return scene;
}

VoxelAsset assetOf(VoxelModel model, std::vector<Material> materials, double voxelMetres) {
    VoxelAsset asset;
    asset.materials = std::move(materials);
    asset.source.voxelSizeMetres = voxelMetres;
    asset.models.push_back(std::move(model));
    asset.instances.push_back({.model = 0, .worldFromModel = Affine(voxelMetres)});
    return asset;
}

VoxelModel hollowBox(const glm::ivec3& inner, int wall) {
    VoxelModel model;
    fillBox(model, {glm::ivec3(-wall), inner + wall}, [&](glm::ivec3 p) -> std::optional<MaterialIndex> {
        const bool inside =
            glm::all(glm::greaterThanEqual(p, glm::ivec3(0))) && glm::all(glm::lessThan(p, inner));
        return inside ? std::nullopt : std::optional<MaterialIndex>(MaterialIndex{0});
    });
    return model;
}

BakeSettings BakeTest::plain(std::uint32_t edge, std::uint32_t samples) {
    BakeSettings settings;
    settings.resolution = {.depth = edge, .light = edge, .irradiance = 8, .moments = 14};
    settings.minSamples = samples;
    settings.maxSamples = samples;
    settings.noiseTarget = 0.0f;
    return settings;
}

LitProbe BakeTest::lightAt(const LoadedScene& scene, const glm::vec3& position,
                           const BakeSettings& settings) {
    LitProbe probe;
    const auto lit = [&]() -> Result<void> {
        DiagnosticList unused;
        const auto models = bake::placedModels(scene);
        const bake::EmitterList emitters = bake::makeEmitters(models);
        bool glass = false;
        for (const auto& placed : models)
            for (const Material& m : placed.asset->materials) glass |= m.transparency > 0.0f;
        PFVOX_TRY(const gpu::Scene, gpuScene, gpu::Scene::build(device(), gpu::partsOf(scene), unused));
        PFVOX_TRY(bake::ProbeTracer, tracer,
                  bake::ProbeTracer::create(device(), gpuScene,
                                            {.sun = scene.scene.sun,
                                             .sky = scene.scene.sky,
                                             .emitters = emitters,
                                             .hasGlass = glass,
                                             .depth = DepthEncoding{}},
                                            settings));
        const auto count = [&](const BakePass& pass) -> Result<void> {
            probe.rays += pass.rays;
            return {};
        };
        const shared::BakeProbe place{.position = position, .index = 0};
        PFVOX_CHECK(tracer.see({&place, 1}, count));
        PFVOX_CHECK(tracer.light(count));
        PFVOX_TRY(auto, seen, tracer.seenTexels(0));
        PFVOX_TRY(bake::TracedProbe, traced, tracer.collect(0));
        PFVOX_TRY(const std::uint64_t, stepLimitRays, tracer.stepLimitRays());
        EXPECT_EQ(stepLimitRays, 0u);
        for (const shared::SeenTexel& texel : seen)
            probe.normals.push_back(shared::octDecode(glm::unpackSnorm2x16(texel.normal)));
        probe.seen = std::move(seen);
        probe.light = std::move(traced.light);
        probe.errors.assign(traced.errors.begin(), traced.errors.end());
        probe.meanError = traced.tiles.meanError.value_or(0.0);
        return {};
    }();
    EXPECT_TRUE(lit) << describe(lit.error());
    return probe;
}

double meanLight(const LitProbe& probe) {
    return meanWhere(probe, [](std::size_t) { return true; }).value;
}

Mean meanWhere(const LitProbe& probe, const std::function<bool(std::size_t)>& counts) {
    Mean mean;
    double squares = 0.0;
    for (std::size_t i = 0; i < probe.light.size(); ++i) {
        if (probe.seen[i].metres < 0.0f || !counts(i)) continue;
        const glm::dvec3 c(probe.light[i]);
        mean.value += (c.x + c.y + c.z) / 3.0;
        squares += probe.errors[i] * probe.errors[i];
        ++mean.texels;
    }
    if (mean.texels == 0) return mean;
    mean.value /= static_cast<double>(mean.texels);
    mean.error = std::sqrt(squares) / static_cast<double>(mean.texels);
    return mean;
}

}  // namespace pfvox::test
