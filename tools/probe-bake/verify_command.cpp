#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <pfvox/face_file.hpp>
#include <pfvox/verify.hpp>

#include "common/json.hpp"
#include "common/text.hpp"
#include "probe-bake/bake_options.hpp"
#include "probe-bake/commands.hpp"
#include "probe-bake/reference_store.hpp"
#include "probe-bake/verify_report.hpp"

namespace pfvox::tools {

namespace {

constexpr const char* kVerifying = "Verifying";
constexpr std::uint32_t kMostSamples = 1u << 20;
constexpr std::uint32_t kSamplesGrowth = 16;  // --max-samples over --samples, when it is not given

struct VerifyOptions {
    CommonOptions common;
    std::vector<std::string> inputs;  ///< scene, probe file
    std::vector<std::string> cameras;
    std::string size = "320x180";
    std::uint32_t samples = VerifySettings{}.samples;
    std::optional<std::uint32_t> maxSamples;
    double referenceNoisePercent = 100.0 * ReferenceTarget{}.noiseOfError;
    std::string references;
    std::string output;
    std::string device;
    bool compact = false;
    bool probes = false;
    std::optional<double> maxRmsePercent;
    std::optional<double> maxFlip;
};

HelpText helpText() {
    return {
        .summary =
            "Renders the indirect light of a scene from its probes and by path tracing, and tells how far "
            "both are apart.",
        .usage = {"probe-bake verify [options] <scene.toml | file.pf_vox> <file.pf_probe>"},
        .examples = {{"probe-bake verify scene.toml scene.pf_probe", "all cameras of the scene"},
                     {"probe-bake verify scene.toml scene.pf_probe --camera room --samples 1024 -o pictures",
                      "one of them, with pictures"},
                     {"probe-bake verify scene.toml scene.pf_probe --max-rmse 8", "fails when it is worse"}}};
}

std::optional<glm::uvec2> parseSize(const std::string& text) {
    unsigned width = 0;
    unsigned height = 0;
    char rest = 0;
    if (std::sscanf(text.c_str(), "%ux%u%c", &width, &height, &rest) != 2) return std::nullopt;
    if (width < 8 || height < 8 || width > 4096 || height > 4096) return std::nullopt;
    return glm::uvec2{width, height};
}

/// A view of the whole from its front, for scenes without cameras.
Camera outsideCamera(const WorldBounds& bounds) {
    const glm::dvec3 center = 0.5 * (bounds.min + bounds.max);
    const double diagonal = glm::length(bounds.max - bounds.min);
    return {.name = "outside", .position = center + diagonal * glm::dvec3{0.5, 0.4, 0.8}, .target = center};
}

Result<std::vector<NamedCamera>> chosenCameras(const VerifyOptions& options, const LoadedScene& scene) {
    std::vector<Camera> all = scene.scene.cameras;
    if (all.empty()) all.push_back(outsideCamera(scene.bounds));
    std::vector<NamedCamera> cameras = namedCameras(all);
    if (options.cameras.empty()) return cameras;
    std::vector<NamedCamera> chosen;
    for (const std::string& name : options.cameras) {
        const auto found = std::ranges::find(all, name, &Camera::name);
        if (found == all.end()) {
            std::string names;
            for (const Camera& camera : all) names += (names.empty() ? "" : ", ") + camera.name;
            return fail(ErrorCode::BadReference,
                        fmt::format("there is no camera \"{}\"; there are: {}", name, names));
        }
        chosen.push_back(cameras[static_cast<std::size_t>(found - all.begin())]);
    }
    return chosen;
}

/// Edge of a voxel of the finest model, metres in the world.
float voxelMetresOf(const LoadedScene& scene) {
    double smallest = std::numeric_limits<double>::infinity();
    for (const PlacedAsset& part : scene.parts) {
        for (int axis = 0; axis < 3; ++axis)
            smallest = std::min(smallest,
                                glm::length(part.worldFromAsset[axis]) * part.asset->source.voxelSizeMetres);
    }
    return std::isfinite(smallest) && smallest > 0.0 ? static_cast<float>(smallest) : 0.1f;
}

ReferenceTarget targetOf(const VerifyOptions& options) {
    return {
        .noiseOfError = options.referenceNoisePercent / 100.0,
        .maxSamples = options.maxSamples.value_or(std::min(kSamplesGrowth * options.samples, kMostSamples))};
}

/// One run over all cameras.
class VerifyRun {
  public:
    VerifyRun(const VerifyOptions& options, const Limits& limits, Reporter& reporter, glm::uvec2 size)
        : options_(options), limits_(limits), reporter_(reporter), size_(size) {}

    Result<void> run() {
        DiagnosticList diagnostics;
        auto status = runAll(diagnostics);
        reporter_.clearProgress();
        reporter_.diagnostics(options_.inputs[0], diagnostics.entries());
        return status;
    }
    std::string text() const { return table_.render() + uncertain_; }
    const std::string& complaint() const { return complaint_; }
    bool withoutValue() const { return withoutValue_; }

  private:
    Result<void> runAll(DiagnosticList& diagnostics) {
        PFVOX_TRY(const LoadedScene, loaded, loadScene(options_.inputs[0], limits_, diagnostics));
        PFVOX_TRY(const std::vector<NamedCamera>, cameras, chosenCameras(options_, loaded));
        PFVOX_TRY(const ProbeFileReader, reader,
                  ProbeFileReader::open(options_.inputs[1], limits_, diagnostics));
        PFVOX_TRY(gpu::Device, device, gpu::Device::open({.selector = options_.device}));
        PFVOX_TRY(const gpu::Scene, scene,
                  gpu::Scene::build(device, gpu::partsOf(loaded), diagnostics,
                                    {.origin = loaded.origin(), .faces = reader.faces().has_value()}));
        PFVOX_TRY(const gpu::GpuProbes, probes,
                  gpu::GpuProbes::upload(device, reader,
                                         {.voxelMetres = voxelMetresOf(loaded),
                                          .origin = scene.origin(),
                                          .compactOnly = options_.compact}));
        std::optional<gpu::GpuFaces> faces;
        if (reader.faces() && !options_.probes && !options_.compact) {
            PFVOX_TRY(const FaceValues, light, readFaceValues(reader, scene));
            PFVOX_TRY(gpu::GpuFaces, made, gpu::GpuFaces::upload(device, scene, light));
            faces = std::move(made);
        }
        PFVOX_TRY(const ProbeVerifier, verifier, ProbeVerifier::create(device));
        const std::uint32_t bounces = reader.info().settings.maxBounces.value_or(kUnlimitedBounces);
        const VerifySettings settings{.width = size_.x,
                                      .height = size_.y,
                                      .samples = options_.samples,
                                      .maxBounces = std::min(bounces, VerifySettings{}.maxBounces)};
        const ReferenceStore store(options_.references, reader.info().sceneHash);
        for (const NamedCamera& named : cameras) {
            const VerifyInput input{.loaded = loaded,
                                    .scene = scene,
                                    .camera = named.camera,
                                    .probes = &probes,
                                    .faces = faces ? &*faces : nullptr};
            PFVOX_TRY(const CameraVerdict, verdict, judge({device, verifier, store, input, named}, settings));
            reporter_.clearProgress();
            report(verdict);
            if (!options_.output.empty()) PFVOX_CHECK(writePictures(options_.output, verdict));
        }
        return {};
    }

    struct Judged {
        gpu::Device& device;
        const ProbeVerifier& verifier;
        const ReferenceStore& store;
        const VerifyInput& input;
        const NamedCamera& named;
    };

    /// Adds paths to the reference until it is good enough for the error that it finds, or may have no more.
    Result<CameraVerdict> judge(const Judged& with, VerifySettings settings) {
        const ReferenceTarget target = targetOf(options_);
        settings.samples = std::min(settings.samples, target.maxSamples);
        ReferencePicture reference = with.store.find(with.named, settings);
        for (;;) {
            reporter_.progress(fmt::format("camera {}: {} paths a pixel", with.named.camera.name,
                                           formatCount(settings.samples)));
            if (reference.samples < settings.samples) {
                PFVOX_TRY(ReferencePicture, traced,
                          with.verifier.trace(with.device, with.input, settings, std::move(reference)));
                PFVOX_CHECK(with.store.keep(with.named, settings, traced));
                reference = std::move(traced);
            }
            PFVOX_TRY(VerifiedPicture, picture, with.verifier.lookUp(with.device, with.input, reference));
            settings.samples = target.nextSamples(partOfAll(picture), reference.samples);
            if (settings.samples > reference.samples) continue;
            VerifyScore score = scoreOf(picture);
            return CameraVerdict{with.named, std::move(picture), std::move(score), reference.samples, target};
        }
    }

    void report(const CameraVerdict& verdict) {
        const VerifyScore& score = verdict.score;
        if (options_.common.json) reporter_.jsonLine(jsonText(verdictJson(verdict)));
        addRow(table_, verdict);
        if (const std::string what = uncertaintyOf(verdict); !what.empty())
            uncertain_ += escaped(verdict.named.camera.name) + ": " + what + "\n";
        const auto add = [&](std::string what) {
            complaint_ +=
                (complaint_.empty() ? "" : "; ") + verdict.named.camera.name + ": " + std::move(what);
        };
        if (score.withoutValue != 0) {
            withoutValue_ = true;
            add(plural(score.withoutValue, "pixel") + " without value");
        }
        if (options_.maxRmsePercent && 100.0 * score.all.relativeRmse > *options_.maxRmsePercent)
            add(fmt::format("RMSE {:.2f} %", 100.0 * score.all.relativeRmse));
        if (options_.maxFlip && score.meanFlip > *options_.maxFlip)
            add(fmt::format("FLIP {:.4f}", score.meanFlip));
    }

    const VerifyOptions& options_;
    const Limits& limits_;
    Reporter& reporter_;
    glm::uvec2 size_;
    Table table_ = verdictTable();
    std::string uncertain_;
    std::string complaint_;
    bool withoutValue_ = false;
};

ExitCode runVerify(const CLI::App& command, const VerifyOptions& options) {
    Reporter reporter(options.common.reporterSettings());
    const auto limits = parseLimits(options.common.limits);
    if (!limits) return usageError(command, limits.error());
    const auto size = parseSize(options.size);
    if (!size)
        return usageError(
            command, "--size " + options.size + ": not two numbers from 8 to 4096 with an x between them");
    VerifyRun run(options, *limits, reporter, *size);
    const auto status = run.run();
    if (!status) {
        reporter.error(status.error());
        return exitCodeOf(status.error().code);
    }
    reporter.result(run.text());
    if (run.complaint().empty()) return ExitCode::Ok;
    reporter.error("the probes fail: " + run.complaint());
    return run.withoutValue() ? ExitCode::InvalidInput : ExitCode::SomeFailed;
}

}  // namespace

Command makeVerifyCommand(CLI::App& tool) {
    auto options = std::make_shared<VerifyOptions>();
    CLI::App& command = addCommand(tool, "verify", helpText());
    command.add_option("input", options->inputs)
        ->required()
        ->expected(2)
        ->check(suggestFiles({".toml", ".pf_vox", kPfProbeExtension}))
        ->group(group::kInputOutput);
    command
        .add_option("-o,--output", options->output,
                    "folder for the pictures: probes, reference, FLIP and tiers")
        ->option_text("FOLDER")
        ->check(outputPath())
        ->check(suggestFiles({}))
        ->group(group::kInputOutput);
    command.add_option("--camera", options->cameras, "a camera of the scene; may be given again")
        ->option_text("NAME")
        ->check(showDefault("all"))
        ->expected(1)
        ->take_all()
        ->allow_extra_args(false)
        ->group(kVerifying);
    command.add_option("--size", options->size, "of the pictures")
        ->option_text("WxH")
        ->check(showDefault(options->size))
        ->group(kVerifying);
    command.add_option("--samples", options->samples, "paths a pixel of the reference, 2 to 65536")
        ->option_text("N")
        ->check(showDefault(options->samples))
        ->check(numberFrom(2, 65536))
        ->group(kVerifying);
    command
        .add_option("--reference-noise", options->referenceNoisePercent,
                    "go on with the reference until its noise is at most so much of the error measured")
        ->option_text("PERCENT")
        ->check(showDefault(options->referenceNoisePercent))
        ->check(numberFrom(0, 1e6))
        ->group(kVerifying);
    command
        .add_option("--max-samples", options->maxSamples, "with at most so many paths a pixel, 2 to 1048576")
        ->option_text("N")
        ->check(showDefault("16 times --samples"))
        ->check(numberFrom(2, kMostSamples))
        ->group(kVerifying);
    command
        .add_option("--references", options->references,
                    "folder of references: paths there are not traced again, new ones are added")
        ->option_text("FOLDER")
        ->check(outputPath())
        ->group(kVerifying);
    command.add_flag("--probes", options->probes, "judge the probes of a file that has light on faces, too")
        ->group(kVerifying);
    command.add_flag("--compact", options->compact, "look at the small maps only")->group(kVerifying);
    command
        .add_option("--max-rmse", options->maxRmsePercent,
                    "fail when RMSE / mean of a camera is above, percent")
        ->option_text("PERCENT")
        ->check(numberFrom(0, 1e6))
        ->group(kVerifying);
    command
        .add_option("--max-flip", options->maxFlip, "fail when the mean FLIP of a camera is above, 0 to 1")
        ->option_text("VALUE")
        ->check(numberFrom(0, 1))
        ->group(kVerifying);
    addDeviceOption(command, options->device);
    addCommonOptions(command, options->common);
    return {.app = &command, .run = [&command, options] { return runVerify(command, *options); }};
}

}  // namespace pfvox::tools
