#include "headless.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <pfvox/pf_vox.hpp>

#include "io/files.hpp"
#include "png.hpp"
#include "report.hpp"

namespace pfvox::viewer {

namespace {

/// loadPfVox, with the command to run when the file is not what pfview reads.
Result<OctreeAsset> loadAsset(const std::filesystem::path& file, Diagnostics& diagnostics) {
    Result<OctreeAsset> asset = loadPfVox(file, Limits{}, diagnostics);
    if (asset) return asset;
    Error error = std::move(asset).error();
    if (error.file.empty()) error.file = file;
    if (error.code == ErrorCode::BadMagic) {
        std::filesystem::path built = file;
        built.replace_extension(".pf_vox");
        error.message = fmt::format("not a PF_VOX file; build one from the source first: vox2pf '{}' -o '{}'",
                                    file.string(), built.string());
        error.context.clear();
        error.offsetBytes.reset();
    } else if (error.code == ErrorCode::UnsupportedVersion) {
        error.message += "; build it again from its source with this version's vox2pf";
    }
    return tl::make_unexpected(std::move(error));
}

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
    PFVOX_TRY(const OctreeAsset, asset, loadAsset(options.file, diagnostics));
    const std::chrono::duration<double, std::milli> loadTime = std::chrono::steady_clock::now() - started;

    PFVOX_TRY(gpu::Device, device,
              gpu::Device::open({.selector = options.device, .validation = options.validation}));
    const gpu::ScenePart part{.asset = &asset};
    PFVOX_TRY(const gpu::Scene, scene, gpu::Scene::build(device, {&part, 1}, diagnostics));
    PFVOX_TRY(const PictureRenderer, renderer, PictureRenderer::create(device));

    const double aspect = static_cast<double>(options.picture.width) / options.picture.height;
    RunReport run{
        .device = device.info(),
        .scene = scene.statistics(),
        .camera = options.camera.value_or(cameraFraming(scene.bounds(), aspect, ViewCamera{}.fovYDegrees)),
        .settings = options.picture,
        .loadMs = loadTime.count()};
    PFVOX_TRY(const Picture, picture,
              renderer.render(device, scene, run.camera, options.picture, run.picture));
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
