#include "headless.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <pfvox/files.hpp>
#include <pfvox/scene.hpp>

#include "atlas_layout.hpp"
#include "camera_path.hpp"
#include "common/text.hpp"
#include "frame_sequence.hpp"
#include "open_path.hpp"
#include "png.hpp"
#include "report.hpp"
#include "view_passes.hpp"

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
    if (run.picture.stepLimitRays != 0) {
        diagnostics.warn("view-step-limit", fmt::format("{} rays were given up after too many steps",
                                                        run.picture.stepLimitRays));
    }
    if (run.picture.withoutValue != 0) {
        diagnostics.warn("view-no-indirect", fmt::format("{} samples have no indirect light in the probes",
                                                         run.picture.withoutValue));
    }
    for (const std::string& message : device.validationMessages())
        diagnostics.warn("vulkan-validation", message);
}

using Clock = std::chrono::steady_clock;
double msSince(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

/// Everything that a picture is drawn from.
struct Stage {
    gpu::Device& device;
    PictureInput input;
    const Options& options;
};

/// Frames one after the other, many in one piece of device work where they are fast.
Result<void> drawFrames(const Stage& stage, FrameSequence& frames, std::uint32_t count, RunReport& run) {
    constexpr double kPieceMs = 200.0;
    std::uint32_t together = 1;
    const Clock::time_point started = Clock::now();
    while (run.frames.size() < count) {
        const auto left = static_cast<std::uint32_t>(count - run.frames.size());
        PFVOX_TRY(
            const DrawnFrames, drawn,
            frames.drawMany(stage.device, stage.input, run.camera, run.settings, std::min(together, left)));
        run.picture += drawn.statistics;
        run.frames.insert(run.frames.end(), drawn.times.begin(), drawn.times.end());
        const double frameMs = std::max(msSince(started) / static_cast<double>(run.frames.size()), 1e-3);
        together = static_cast<std::uint32_t>(
            std::clamp(kPieceMs / frameMs, 1.0, 1.0 * FrameSequence::kMaxTogether));
    }
    run.wallMs = msSince(started);
    return {};
}

/// The mean of several frames; statistics are those of all together.
Result<void> drawAccumulated(const Stage& stage, RunReport& run) {
    PFVOX_TRY(FrameSequence, frames, FrameSequence::create(stage.device));
    PFVOX_CHECK(drawFrames(stage, frames, stage.options.frames, run));
    PFVOX_TRY(const Picture, picture, frames.picture(stage.device));
    return writePng(stage.options.screenshot, picture);
}

/// Frames without a picture, once programs are made and clocks are up.
Result<void> measure(const Stage& stage, RunReport& run) {
    constexpr double kWarmUpMs = 300.0;
    PFVOX_TRY(FrameSequence, frames, FrameSequence::create(stage.device));
    const Clock::time_point started = Clock::now();
    std::uint32_t together = 1;
    do {
        PFVOX_TRY(const DrawnFrames, drawn,
                  frames.drawMany(stage.device, stage.input, run.camera, run.settings, together));
        if (sumOf(drawn.times.back()) < 2.0) together = FrameSequence::kMaxTogether;
    } while (msSince(started) < kWarmUpMs);
    return drawFrames(stage, frames, stage.options.frames, run);
}

/// "flight.png" -> "flight-0001.png" and so on.
std::filesystem::path numbered(const std::filesystem::path& file, std::uint32_t number) {
    const std::string name =
        fmt::format("{}-{:04}{}", file.stem().string(), number, file.extension().string());
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

/// One picture and its times.
Result<Picture> drawStill(const Stage& stage, const PictureRenderer& renderer, RunReport& run) {
    PictureStatistics one;
    const Clock::time_point started = Clock::now();
    PFVOX_TRY(Picture, picture, renderer.render(stage.device, stage.input, run.camera, run.settings, one));
    run.wallMs += msSince(started);
    run.picture += one;
    run.frames.push_back(one.passMs);
    return picture;
}

Result<void> drawFlight(const Stage& stage, RunReport& run) {
    PFVOX_TRY(const CameraPath, path, readCameraPath(stage.options.cameraPath));
    PFVOX_TRY(const PictureRenderer, renderer, PictureRenderer::create(stage.device));
    for (std::uint32_t i = 0; i < stage.options.frames; ++i) {
        run.camera = path.atFrame(i, stage.options.frames);
        PFVOX_TRY(const Picture, picture, drawStill(stage, renderer, run));
        PFVOX_CHECK(writePng(numbered(stage.options.screenshot, i + 1), picture));
    }
    return {};
}

Result<void> drawOne(const Stage& stage, RunReport& run) {
    PFVOX_TRY(const PictureRenderer, renderer, PictureRenderer::create(stage.device));
    PFVOX_TRY(const Picture, picture, drawStill(stage, renderer, run));
    return writePng(stage.options.screenshot, picture);
}

Result<void> draw(const Stage& stage, RunReport& run) {
    if (stage.options.screenshot.empty()) return measure(stage, run);
    if (!stage.options.cameraPath.empty()) return drawFlight(stage, run);
    return stage.options.frames > 1 ? drawAccumulated(stage, run) : drawOne(stage, run);
}

/// --probe and --probe-page name what is there.
Result<void> checkAtlas(const PictureSettings& settings, const ShownProbes* probes) {
    if (probes == nullptr) return {};
    const auto count = static_cast<std::uint32_t>(probes->probes.size());
    if (settings.atlas.probe >= static_cast<std::int64_t>(count)) {
        return fail(ErrorCode::BadReference, fmt::format("--probe {}: the field has {} probes, from 0 on",
                                                         settings.atlas.probe, count));
    }
    const std::uint32_t pages = atlasLayout(settings, count).pages;
    if (!isAtlas(settings.mode) || settings.atlas.page < pages) return {};
    return fail(ErrorCode::BadReference,
                fmt::format("--probe-page {}: the {} probes are on {} at this size, from 0 on",
                            settings.atlas.page, count, tools::plural(pages, "page")));
}

/// As many rays for each pixel of a picture, however many samples and frames it is made of.
std::uint32_t ambientRaysOf(const Options& options) {
    constexpr std::uint32_t kRaysOfPixel = 64;
    if (options.screenshot.empty()) return kFrameAmbientRays;
    const std::uint64_t frames = options.cameraPath.empty() ? options.frames : 1;
    const std::uint64_t samples = frames * options.picture.samplesPerPixel;
    return static_cast<std::uint32_t>(std::max<std::uint64_t>(kRaysOfPixel / samples, 1));
}

}  // namespace

Result<void> runHeadless(const Options& options, Diagnostics& diagnostics) {
    const auto started = std::chrono::steady_clock::now();
    PFVOX_TRY(const OpenPath, path, openPath(options.file));
    ProbeRequest request = options.probes;
    if (request.file.empty() && !request.none) request.file = path.probes;
    PFVOX_TRY(const LoadedScene, loaded, loadScene(path.file, Limits{}, diagnostics));
    PFVOX_TRY(const std::optional<ViewCamera>, camera, chosenCamera(options.camera, path.file, loaded.scene));
    PictureSettings settings = options.picture;
    settings.lighting = lightingOf(loaded.scene);
    settings.ambientRays = ambientRaysOf(options);
    settings.ground = options.ground.value_or(isSingleModel(path.file, loaded.scene));
    settings.lighting.exposure = static_cast<float>(std::exp2(options.exposureStops.value_or(0.0)));
    const std::chrono::duration<double, std::milli> loadTime = std::chrono::steady_clock::now() - started;

    PFVOX_TRY(gpu::Device, device,
              gpu::Device::open({.selector = options.device, .validation = options.validation}));
    PFVOX_TRY(const gpu::Scene, scene,
              gpu::Scene::build(device, gpu::partsOf(loaded), diagnostics,
                                {.origin = loaded.origin(), .faces = true}));
    PFVOX_TRY(const std::optional<ShownProbes>, probes,
              findProbes(device, request, loaded, scene, path.file, diagnostics));
    const ShownProbes* const light = probes ? &*probes : nullptr;
    if (light != nullptr) diagnostics.note("probes", "indirect light from " + light->file.string());
    PFVOX_CHECK(checkView(settings.mode, light, path.file));
    PFVOX_CHECK(checkAtlas(settings, light));
    std::optional<GpuEmitters> emitters;
    if (isGuessed({scene, light}, settings)) {
        PFVOX_TRY(GpuEmitters, made, GpuEmitters::upload(device, loaded, diagnostics));
        emitters.emplace(std::move(made));
        if (light == nullptr) diagnostics.note("no-probes", guessNote(path.file));
    }

    const double aspect = static_cast<double>(options.picture.width) / options.picture.height;
    RunReport run{.device = device.info(),
                  .scene = scene.statistics(),
                  .camera = camera.value_or(cameraFraming(scene.bounds(), aspect, ViewCamera{}.fovYDegrees)),
                  .settings = settings,
                  .probes = light,
                  .loadMs = loadTime.count()};
    PFVOX_CHECK(draw({device, {scene, light, emitters ? &*emitters : nullptr}, options}, run));
    run.memory = device.memory();
    PFVOX_CHECK(writeStatistics(options.statisticsFile, toJson(run)));
    reportFindings(run, device, diagnostics);
    if (!device.validationMessages().empty()) {
        return fail(ErrorCode::Internal, "the Vulkan validation layer has complaints");
    }
    return {};
}

}  // namespace pfvox::viewer
