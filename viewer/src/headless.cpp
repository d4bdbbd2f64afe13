#include "headless.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <pfvox/scene.hpp>

#include "io/files.hpp"
#include "png.hpp"
#include "report.hpp"

namespace pfvox::viewer {

namespace {

Result<void> writeStatistics(const std::string& target, const std::string& json) {
    if (target.empty()) return {};
    if (target == "-") {
        if (std::fputs(json.c_str(), stdout) < 0 || std::fflush(stdout) != 0) {
            return fail(ErrorCode::FileNotWritable, "cannot write to stdout");
        }
        return {};
    }
    return io::writeFileAtomically(target, std::as_bytes(std::span(json)));
}

void reportFindings(const RunReport& run, const gpu::Device& device, Diagnostics& diagnostics) {
    if (run.picture.cappedRays != 0) {
        diagnostics.warn("view-capped-rays",
                         fmt::format("{} rays were given up after too many steps", run.picture.cappedRays));
    }
    for (const std::string& message : device.validationMessages())
        diagnostics.warn("vulkan-validation", message);
}

}  // namespace

Result<void> runHeadless(const Options& options, Diagnostics& diagnostics) {
    const auto started = std::chrono::steady_clock::now();
    PFVOX_TRY(const LoadedScene, loaded, loadScene(options.file, Limits{}, diagnostics));
    PFVOX_TRY(const std::optional<ViewCamera>, camera, chosenCamera(options.camera, options.file, loaded.scene));
    PictureSettings settings = options.picture;
    settings.lighting = lightingOf(loaded.scene);
    const std::chrono::duration<double, std::milli> loadTime = std::chrono::steady_clock::now() - started;

    PFVOX_TRY(gpu::Device, device,
              gpu::Device::open({.selector = options.device, .validation = options.validation}));
    PFVOX_TRY(const gpu::Scene, scene, gpu::Scene::build(device, gpu::partsOf(loaded), diagnostics));
    PFVOX_TRY(const PictureRenderer, renderer, PictureRenderer::create(device));

    const double aspect = static_cast<double>(options.picture.width) / options.picture.height;
    RunReport run{.device = device.info(),
                  .scene = scene.statistics(),
                  .camera = camera.value_or(cameraFraming(scene.bounds(), aspect, ViewCamera{}.fovYDegrees)),
                  .settings = settings,
                  .loadMs = loadTime.count()};
    PFVOX_TRY(const Picture, picture, renderer.render(device, scene, run.camera, settings, run.picture));
    run.memory = device.memory();
    PFVOX_CHECK(writePng(options.screenshot, picture));
    PFVOX_CHECK(writeStatistics(options.statisticsFile, toJson(run)));
    reportFindings(run, device, diagnostics);
    if (!device.validationMessages().empty()) {
        return fail(ErrorCode::Internal, "the Vulkan validation layer has complaints");
    }
    return {};
}

}  // namespace pfvox::viewer
