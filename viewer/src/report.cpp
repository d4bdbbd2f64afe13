#include "report.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace pfvox::viewer {

namespace {

using Json = nlohmann::ordered_json;

Json vectorJson(const glm::dvec3& v) {
    return {v.x, v.y, v.z};
}

Json sceneJson(const gpu::SceneStatistics& scene) {
    const auto bytes = static_cast<double>(scene.totalBytes());
    return {{"models", scene.models},
            {"instances", scene.instances},
            {"regions", scene.regions},
            {"materials", scene.materials},
            {"bvhNodes", scene.bvhNodes},
            {"voxels", scene.voxels},
            {"nodeBytes", scene.nodeBytes},
            {"lodBytes", scene.lodBytes},
            {"valueBytes", scene.valueBytes},
            {"paletteBytes", scene.paletteBytes},
            {"instanceBytes", scene.instanceBytes},
            {"totalBytes", scene.totalBytes()},
            {"bytesPerVoxel", scene.voxels == 0 ? 0.0 : bytes / static_cast<double>(scene.voxels)},
            {"buildMs", scene.buildMs}};
}

Json pictureJson(const PictureSettings& settings, const PictureStatistics& picture) {
    const auto rays = static_cast<double>(picture.cameraRays);
    return {{"width", settings.width},
            {"height", settings.height},
            {"samplesPerPixel", settings.samplesPerPixel},
            {"lodPixels", settings.lodPixels},
            {"view", std::string(toString(settings.mode))},
            {"gpuMs", picture.gpuMs},
            {"cameraRays", picture.cameraRays},
            {"cameraRaysPerSecond", picture.gpuMs > 0.0 ? rays / picture.gpuMs * 1e3 : 0.0},
            {"hits", picture.hits},
            {"steps", picture.steps},
            {"stepsPerCameraRay", rays > 0.0 ? static_cast<double>(picture.steps) / rays : 0.0},
            {"cappedRays", picture.cappedRays}};
}

}  // namespace

int exitCodeOf(ErrorCode code) {
    switch (static_cast<int>(code) / 100) {
        case 1:
            return 3;
        case 2:
            return 4;
        case 3:
            return 5;
        case 4:
            return 4;
        case 5:
            return 6;
        case 6:
            return 130;
        default:
            return 70;
    }
}

std::string deviceTable(const std::vector<gpu::DeviceInfo>& devices) {
    std::string text;
    for (const gpu::DeviceInfo& device : devices) {
        text += fmt::format("{}  {}  ({}, Vulkan {}.{}, {} MiB, {}){}\n", device.index, device.name,
                            gpu::toString(device.kind), device.apiVersionMajor, device.apiVersionMinor,
                            device.localMemoryBytes >> 20, device.driver,
                            device.usable() ? "" : "  not usable: lacks " + device.missing);
    }
    return text;
}

std::string toJson(const RunReport& report) {
    const Json json{{"device",
                     {{"index", report.device.index},
                      {"name", report.device.name},
                      {"kind", gpu::toString(report.device.kind)},
                      {"driver", report.device.driver}}},
                    {"loadMs", report.loadMs},
                    {"scene", sceneJson(report.scene)},
                    {"camera",
                     {{"position", vectorJson(report.camera.position)},
                      {"target", vectorJson(report.camera.target)},
                      {"fovYDegrees", report.camera.fovYDegrees}}},
                    {"picture", pictureJson(report.settings, report.picture)},
                    {"deviceMemory",
                     {{"currentBytes", report.memory.currentBytes}, {"peakBytes", report.memory.peakBytes}}}};
    return json.dump(2) + "\n";
}

}  // namespace pfvox::viewer
