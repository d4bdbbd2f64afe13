// Light on faces: seconds, rays and values of a bake by its settings, and how far each camera's picture of it
// is from path tracing, as JSON lines. Probes of the same scene can be judged by the same references.
//
//     bench_faces scene.toml [--set base=256,min=256,max=16384,noise=0.005,divide=1]... [--probes file]...
#include <CLI/CLI.hpp>
#include <chrono>
#include <iostream>
#include <nlohmann/json.hpp>
#include <pfvox/gpu_faces.hpp>
#include <pfvox/probe_file.hpp>
#include <pfvox/verify.hpp>

#include "bake/placed_models.hpp"
#include "faces/face_tracer.hpp"

namespace pfvox::bench {
namespace {

using Json = nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;

struct Options {
    std::string scene;
    std::string name;  ///< in the lines
    std::vector<std::string> settings;
    std::vector<std::string> probes;
    std::vector<std::string> cameras;
    std::string device;
    std::string size = "320x180";
    std::uint32_t samples = 1024;
    std::uint32_t maxSamples = 16384;
    std::uint32_t repetitions = 1;
    bool validate = false;
};

double secondsSince(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

Result<FaceSettings> settingsOf(const std::string& text) {
    FaceSettings settings;
    std::istringstream parts(text);
    for (std::string part; std::getline(parts, part, ',');) {
        const std::size_t equals = part.find('=');
        const std::string name = part.substr(0, equals);
        const double value = std::stod(part.substr(equals + 1));
        if (name == "base")
            settings.baseRays = static_cast<std::uint32_t>(value);
        else if (name == "min")
            settings.minRays = static_cast<std::uint32_t>(value);
        else if (name == "max")
            settings.maxRays = static_cast<std::uint32_t>(value);
        else if (name == "noise")
            settings.noiseTarget = static_cast<float>(value);
        else if (name == "divide")
            settings.divide = value != 0.0;
        else
            return fail(ErrorCode::BadValue, "there is no setting " + name);
    }
    return settings;
}

Json jsonOf(const VerifyPart& part) {
    return {{"rmse", part.relativeRmse},
            {"error", part.relativeError},
            {"trimmed", part.relativeTrimmedRmse},
            {"bias", part.relativeBias},
            {"noise", part.relativeNoise}};
}

/// References of the cameras, traced as far as the best of what they judge asks for.
class Judge {
  public:
    Judge(gpu::Device& device, const LoadedScene& loaded, const gpu::Scene& scene,
          const ProbeVerifier& verifier, const Options& options, VerifySettings settings)
        : device_(device),
          loaded_(loaded),
          scene_(scene),
          verifier_(verifier),
          options_(options),
          settings_(settings) {}

    Result<void> judge(const std::string& what, const gpu::GpuProbes* probes, const gpu::GpuFaces* faces) {
        for (const Camera& camera : loaded_.scene.cameras) {
            const std::string name = camera.name;
            if (!options_.cameras.empty() &&
                std::ranges::find(options_.cameras, name) == options_.cameras.end())
                continue;
            const VerifyInput input{loaded_, scene_, camera, probes, faces};
            ReferencePicture& reference = references_[name];
            const ReferenceTarget target{.maxSamples = options_.maxSamples};
            VerifySettings settings = settings_;
            settings.samples = std::max(options_.samples, reference.samples);
            VerifiedPicture picture;
            for (;;) {
                PFVOX_TRY(ReferencePicture, traced,
                          verifier_.trace(device_, input, settings, std::move(reference)));
                reference = std::move(traced);
                PFVOX_TRY(VerifiedPicture, looked, verifier_.lookUp(device_, input, reference));
                picture = std::move(looked);
                const std::uint32_t next = target.nextSamples(partOfAll(picture), settings.samples);
                if (next == settings.samples) break;
                settings.samples = next;
            }
            const VerifyScore score = scoreOf(picture);
            Json row{
                {"what", what}, {"scene", options_.name}, {"camera", name}, {"samples", settings.samples}};
            row.update(jsonOf(score.all));
            row["flip"] = score.meanFlip;
            row["noiseFlip"] = score.noiseFlip;
            row["withoutValue"] = score.withoutValue;
            row["lookupMs"] = picture.gpuMs;
            std::cout << row.dump() << std::endl;
        }
        return {};
    }

  private:
    gpu::Device& device_;
    const LoadedScene& loaded_;
    const gpu::Scene& scene_;
    const ProbeVerifier& verifier_;
    const Options& options_;
    VerifySettings settings_;
    std::map<std::string, ReferencePicture> references_;
};

Result<void> run(const Options& options) {
    PFVOX_TRY(gpu::Device, device,
              gpu::Device::open({.selector = options.device, .validation = options.validate}));
    DiagnosticList diagnostics;
    PFVOX_TRY(const LoadedScene, loaded, loadScene(options.scene, Limits{}, diagnostics));
    auto began = Clock::now();
    PFVOX_TRY(const gpu::Scene, scene,
              gpu::Scene::build(device, gpu::partsOf(loaded), diagnostics,
                                {.origin = loaded.origin(), .faces = true}));
    const double buildSeconds = secondsSince(began);
    PFVOX_TRY(const ProbeVerifier, verifier, ProbeVerifier::create(device));
    VerifySettings size;
    if (std::sscanf(options.size.c_str(), "%ux%u", &size.width, &size.height) != 2)
        return fail(ErrorCode::BadValue, "--size needs WxH");
    Judge judge(device, loaded, scene, verifier, options, size);
    for (const std::string& text : options.settings) {
        PFVOX_TRY(const FaceSettings, faceSettings, settingsOf(text));
        BakeSettings settings;
        settings.faces = faceSettings;
        bake::TracedFaces traced;
        double seconds = 1e30;
        for (std::uint32_t i = 0; i < options.repetitions; ++i) {
            began = Clock::now();
            const bake::EmitterList emitters =
                bake::makeEmitters(bake::placedModels(loaded, loaded.origin()));
            PFVOX_TRY(bake::FaceTracer, tracer,
                      bake::FaceTracer::create(device, scene, loaded.scene.sun, loaded.scene.sky, emitters,
                                               settings));
            PFVOX_TRY(bake::TracedFaces, faces,
                      tracer.run([](const BakePass&) -> Result<void> { return {}; }));
            seconds = std::min(seconds, secondsSince(began));
            traced = std::move(faces);
        }
        PFVOX_TRY(const gpu::GpuFaces, faces, gpu::GpuFaces::upload(device, scene, traced.light));
        const auto pass = [](const BakePass& p) { return Json{{"rays", p.rays}, {"gpuMs", p.gpuMs}}; };
        std::cout << Json{{"what", text},
                          {"scene", options.name},
                          {"device", device.info().name},
                          {"seconds", seconds},
                          {"sceneSeconds", buildSeconds},
                          {"faces", scene.faceCount()},
                          {"divided", traced.dividedFaces},
                          {"values", traced.light.values.size()},
                          {"sweeps", traced.sweeps},
                          {"noise", traced.meanNoise},
                          {"noisyFraction",
                           static_cast<double>(traced.noisyValues) / std::max(scene.faceCount(), 1u)},
                          {"sun", pass(traced.sun)},
                          {"links", pass(traced.links)},
                          {"solve", pass(traced.solve)},
                          {"light", pass(traced.gather)},
                          {"indexBytes", scene.statistics().faceBytes},
                          {"deviceBytes", faces.statistics().totalBytes()}}
                         .dump()
                  << std::endl;
        PFVOX_CHECK(judge.judge(text, nullptr, &faces));
    }
    for (const std::string& file : options.probes) {
        PFVOX_TRY(const ProbeFileReader, reader, ProbeFileReader::open(file, Limits{}, diagnostics));
        const float voxel = bake::finestVoxelMetres(bake::placedModels(loaded));
        PFVOX_TRY(const gpu::GpuProbes, probes,
                  gpu::GpuProbes::upload(device, reader, {.voxelMetres = voxel, .origin = scene.origin()}));
        PFVOX_CHECK(judge.judge(file, &probes, nullptr));
    }
    for (const std::string& message : device.validationMessages()) std::cerr << message << '\n';
    if (!device.validationMessages().empty())
        return fail(ErrorCode::Internal, "the validation layer has something to say");
    return {};
}

int main(int argc, char** argv) {
    Options options;
    CLI::App app("Light on faces by its settings, as JSON lines.");
    app.add_option("scene", options.scene, "scene file")->required();
    app.add_option("--name", options.name, "of the scene, in the lines");
    app.add_option("--set", options.settings, "settings of a bake, name=value,...");
    app.add_option("--probes", options.probes, "baked probes of the scene");
    app.add_option("--camera", options.cameras, "only these");
    app.add_option("--device", options.device, "index or part of the name");
    app.add_option("--size", options.size, "WxH of the pictures");
    app.add_option("--samples", options.samples, "paths a pixel of the reference, at least");
    app.add_option("--max-samples", options.maxSamples, "and at most");
    app.add_option("--repetitions", options.repetitions, "bakes, of which the fastest counts");
    app.add_flag("--validate", options.validate, "with the validation layer");
    CLI11_PARSE(app, argc, argv);
    if (options.name.empty()) options.name = options.scene;
    const Result<void> done = run(options);
    if (done) return 0;
    std::cerr << "bench_faces: " << describe(done.error()) << '\n';
    return 1;
}

}  // namespace
}  // namespace pfvox::bench

int main(int argc, char** argv) {
    return pfvox::bench::main(argc, argv);
}
