#include "report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
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
            {"exposureStops", std::log2(static_cast<double>(settings.lighting.exposure))},
            {"toneMap", std::string(toString(settings.toneMap))},
            {"ground", settings.ground},
            {"gpuMs", picture.gpuMs},
            {"cameraRays", picture.cameraRays},
            {"cameraRaysPerSecond", picture.gpuMs > 0.0 ? rays / picture.gpuMs * 1e3 : 0.0},
            {"sunRays", picture.sunRays},
            {"ambientRays", picture.ambientRays},
            {"reflectionRays", picture.reflectionRays},
            {"hits", picture.hits},
            {"steps", picture.steps},
            {"stepsPerCameraRay", rays > 0.0 ? static_cast<double>(picture.steps) / rays : 0.0},
            {"stepLimitRays", picture.stepLimitRays}};
}

/// Where the indirect light of a picture comes from; null where it has none.
Json indirectJson(const RunReport& report) {
    if (!entryOf(report.settings.mode).isRadiance || isAtlas(report.settings.mode)) return nullptr;
    return report.probes != nullptr ? "probes" : "approximation";
}

Json probesJson(const ShownProbes* probes) {
    if (probes == nullptr) return nullptr;
    const gpu::GpuProbeStatistics& s = probes->field.statistics();
    return {{"file", probes->file.string()},
            {"ofThisScene", probes->ofThisScene},
            {"count", s.probes},
            {"active", s.active},
            {"bytes", s.totalBytes()}};
}

Json lightJson(const PictureStatistics& picture) {
    std::uint64_t samples = 0;
    for (const std::uint64_t tier : picture.tiers) samples += tier;
    if (samples == 0) return nullptr;
    Json fractions;
    for (std::size_t i = 0; i < picture.tiers.size(); ++i) {
        fractions[std::string(gpu::toString(static_cast<gpu::ProbeTier>(i)))] =
            static_cast<double>(picture.tiers[i]) / static_cast<double>(samples);
    }
    return {{"lookups", samples}, {"withoutValue", picture.withoutValue}, {"tierFractions", fractions}};
}

Json fieldJson(const PictureStatistics& picture) {
    const auto& [miss, hit, unknown] = picture.fieldStates;
    if (miss + hit + unknown == 0) return nullptr;
    return {{"misses", miss}, {"hits", hit}, {"unknown", unknown}, {"agrees", picture.fieldAgrees}};
}

/// Mean, median and 95th percentile.
Json spreadJson(std::vector<double> values) {
    std::ranges::sort(values);
    double sum = 0.0;
    for (const double value : values) sum += value;
    const auto at = [&](double fraction) {
        return values[static_cast<std::size_t>(fraction * static_cast<double>(values.size() - 1) + 0.5)];
    };
    return {{"mean", sum / static_cast<double>(values.size())}, {"median", at(0.5)}, {"p95", at(0.95)}};
}

Json framesJson(const RunReport& report) {
    if (report.frames.empty()) return nullptr;
    Json passes = Json::object();
    for (std::size_t pass = 0; pass < kPasses; ++pass) {
        std::vector<double> times;
        for (const PassTimes& frame : report.frames) times.push_back(frame[pass]);
        if (std::ranges::any_of(times, [](double t) { return t > 0.0; }))
            passes[std::string(toString(static_cast<Pass>(pass)))] = spreadJson(std::move(times));
    }
    std::vector<double> totals;
    for (const PassTimes& frame : report.frames) totals.push_back(sumOf(frame));
    const auto count = static_cast<double>(report.frames.size());
    return {{"count", report.frames.size()},
            {"wallMs", report.wallMs},
            {"framesPerSecond", report.wallMs > 0.0 ? 1e3 * count / report.wallMs : 0.0},
            {"gpuMs", spreadJson(std::move(totals))},
            {"passMs", passes}};
}

}  // namespace

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
                    {"frames", framesJson(report)},
                    {"probes", probesJson(report.probes)},
                    {"indirect", indirectJson(report)},
                    {"light", lightJson(report.picture)},
                    {"field", fieldJson(report.picture)},
                    {"deviceMemory",
                     {{"currentBytes", report.memory.currentBytes}, {"peakBytes", report.memory.peakBytes}}}};
    return json.dump(2) + "\n";
}

}  // namespace pfvox::viewer
