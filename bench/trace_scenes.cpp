#include "trace_scenes.hpp"

#include <algorithm>
#include <pfvox/pf_vox.hpp>
#include <pfvox/scene.hpp>

#include "measured_models.hpp"
#include "noise.hpp"

namespace pfvox::bench {

namespace {

std::vector<TraceCamera> sphereCameras() {
    const glm::dvec3 c(256.0);
    return {{"near", c + glm::dvec3(150, 110, 160), c, 60.0},
            {"far", c + glm::dvec3(700, 500, 800), c, 20.0},
            {"grazing", c + glm::dvec3(0.3, 147.3, 0.2), c + glm::dvec3(130, 120, 60), 60.0}};
}

std::vector<TraceCamera> shellCameras() {
    const glm::dvec3 c(1024.0);
    return {{"near", c + glm::dvec3(900, 700, 800), c, 60.0},
            {"far", c + glm::dvec3(3000, 2000, 3200), c, 30.0},
            {"inside", c + glm::dvec3(400.3, 100.7, -300.1), c + glm::dvec3(-900, -100, 300), 70.0}};
}

std::vector<TraceCamera> terrainCameras() {
    const double nearY = terrainHeight(700, 700) + 60.5;
    double ridge = 0.0;
    for (int s = 0; s < 200; ++s)
        ridge = std::max(ridge, static_cast<double>(terrainHeight(200 + s / 4, 200 + s / 4)));
    return {{"near", {700.3, nearY, 700.6}, {1000, nearY - 200, 960}, 60.0},
            {"far", {-900, 1900, -1000}, {1024, 650, 1024}, 45.0},
            {"grazing", {200.4, ridge + 8.5, 200.7}, {1800, ridge - 10, 1700}, 60.0}};
}

/// From a quarter of the way, from outside of everything, and along the ground.
std::vector<TraceCamera> fittedCameras(const OctreeAsset& asset) {
    const WorldBounds box = boundsOf(asset);
    const glm::dvec3 size = box.max - box.min;
    const auto at = [&](double x, double y, double z) { return box.min + glm::dvec3(x, y, z) * size; };
    const double across = std::max(size.x, size.z);
    return {{"near", at(0.3, 1.0, 0.3) + glm::dvec3(0, 0.05 * across, 0), at(0.6, 0.3, 0.6), 60.0},
            {"far", at(-0.6, 1.0, -0.7) + glm::dvec3(0, 0.7 * across, 0), at(0.5, 0.3, 0.5), 45.0},
            {"grazing", at(-0.02, 0.6, -0.02), at(1.0, 0.5, 0.9), 60.0}};
}

Result<TraceScene> measuredScene(const std::string& name) {
    const MeasuredModel source = makeMeasuredModel(name);
    TraceScene scene{.name = name, .asset = {}, .cameras = {}, .singleModel = true};
    OctreeAsset& asset = scene.asset;
    for (int i = 0; i < source.materialCount; ++i) {
        const std::uint32_t h = hash32(static_cast<std::uint32_t>(i) + 1);
        asset.materials.push_back({.baseColor = {h & 0xffu, h >> 8 & 0xffu, h >> 16 & 0xffu, 255}});
    }
    PFVOX_TRY(OctreeModel, model,
              buildOctree({.voxels = source.voxels, .name = name}, asset.materials.size(), Limits{}));
    asset.models.push_back(std::move(model));
    asset.instances.emplace_back();
    scene.cameras = name == "sphere"    ? sphereCameras()
                    : name == "shell"   ? shellCameras()
                    : name == "terrain" ? terrainCameras()
                                        : fittedCameras(asset);
    return scene;
}

}  // namespace

Result<TraceScene> makeTraceScene(const std::string& what) {
    if (std::ranges::find(kMeasuredModelNames, what) != kMeasuredModelNames.end()) return measuredScene(what);
    TraceScene scene{.name = std::filesystem::path(what).stem().string(), .asset = {}, .cameras = {}};
    DiagnosticList diagnostics;
    PFVOX_TRY(OctreeAsset, asset, loadPfVox(what, Limits{}, diagnostics));
    scene.asset = std::move(asset);
    scene.cameras = fittedCameras(scene.asset);
    return scene;
}

}  // namespace pfvox::bench
