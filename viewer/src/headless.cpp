#include "headless.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <pfvox/files.hpp>
#include <pfvox/scene.hpp>

#include "camera_path.hpp"
#include "frame_sequence.hpp"
#include "open_path.hpp"
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

/// Everything that a picture is drawn from.
struct Stage {
    gpu::Device& device;
    const gpu::Scene& scene;
    const Options& options;
};

/// The mean of several frames; statistics are those of all together.
Result<void> drawAccumulated(const Stage& stage, RunReport& run) {
    PFVOX_TRY(FrameSequence, frames, FrameSequence::create(stage.device));
    for (std::uint32_t i = 0; i < stage.options.frames; ++i) {
        PFVOX_TRY(const PictureStatistics, frame, frames.draw(stage.device, stage.scene, run.camera, run.settings));
        run.picture += frame;
    }
    PFVOX_TRY(const Picture, picture, frames.picture(stage.device));
    return writePng(stage.options.screenshot, picture);
}

/// "flight.png" -> "flight-0001.png" and so on.
std::filesystem::path numbered(const std::filesystem::path& file, std::uint32_t number) {
    const std::string name = fmt::format("{}-{:04}{}", file.stem().string(), number, file.extension().string());
    return file.parent_path() / name;
}

Result<CameraPath> readCameraPath(const std::filesystem::path& file) {
    constexpr std::uint64_t kMaxBytes = 16u << 20;
    PFVOX_TRY(const io::FileBytes, bytes, io::readFile(file, kMaxBytes));
    const std::span<const std::byte> b = bytes.bytes();
    Result<CameraPath> path = CameraPath::parse({reinterpret_cast<const char*>(b.data()), b.size()});
    if (path) return path;
    Error error = path.error();
    error.file = file;
    return tl::make_unexpected(std::move(error));
}

Result<void> drawFlight(const Stage& stage, RunReport& run) {
    PFVOX_TRY(const CameraPath, path, readCameraPath(stage.options.cameraPath));
    PFVOX_TRY(const PictureRenderer, renderer, PictureRenderer::create(stage.device));
    for (std::uint32_t i = 0; i < stage.options.frames; ++i) {
        run.camera = path.atFrame(i, stage.options.frames);
        PictureStatistics one;
        PFVOX_TRY(const Picture, picture, renderer.render(stage.device, stage.scene, run.camera, run.settings, one));
        run.picture += one;
        PFVOX_CHECK(writePng(numbered(stage.options.screenshot, i + 1), picture));
    }
    return {};
}

Result<void> drawOne(const Stage& stage, RunReport& run) {
    PFVOX_TRY(const PictureRenderer, renderer, PictureRenderer::create(stage.device));
    PFVOX_TRY(const Picture, picture,
              renderer.render(stage.device, stage.scene, run.camera, run.settings, run.picture));
    return writePng(stage.options.screenshot, picture);
}

Result<void> draw(const Stage& stage, RunReport& run) {
    if (!stage.options.cameraPath.empty()) return drawFlight(stage, run);
    return stage.options.frames > 1 ? drawAccumulated(stage, run) : drawOne(stage, run);
}

}  // namespace

Result<void> runHeadless(const Options& options, Diagnostics& diagnostics) {
    const auto started = std::chrono::steady_clock::now();
    PFVOX_TRY(const OpenPath, path, openPath(options.file));
    PFVOX_TRY(const LoadedScene, loaded, loadScene(path.file, Limits{}, diagnostics));
    PFVOX_TRY(const std::optional<ViewCamera>, camera, chosenCamera(options.camera, path.file, loaded.scene));
    PictureSettings settings = options.picture;
    settings.lighting = lightingOf(loaded.scene);
    const std::chrono::duration<double, std::milli> loadTime = std::chrono::steady_clock::now() - started;

    PFVOX_TRY(gpu::Device, device,
              gpu::Device::open({.selector = options.device, .validation = options.validation}));
    PFVOX_TRY(const gpu::Scene, scene, gpu::Scene::build(device, gpu::partsOf(loaded), diagnostics));

    const double aspect = static_cast<double>(options.picture.width) / options.picture.height;
    RunReport run{.device = device.info(),
                  .scene = scene.statistics(),
                  .camera = camera.value_or(cameraFraming(scene.bounds(), aspect, ViewCamera{}.fovYDegrees)),
                  .settings = settings,
                  .loadMs = loadTime.count()};
    PFVOX_CHECK(draw({device, scene, options}, run));
    run.memory = device.memory();
    PFVOX_CHECK(writeStatistics(options.statisticsFile, toJson(run)));
    reportFindings(run, device, diagnostics);
    if (!device.validationMessages().empty()) {
        return fail(ErrorCode::Internal, "the Vulkan validation layer has complaints");
    }
    return {};
}

}  // namespace pfvox::viewer
