// Ray casting speed: primary, shadow and diffuse rays over models and scenes, timed on the device, as JSON
// lines. Run: bench_trace sphere shell terrain landscape city.pf_vox [--device nvidia] [--size 3840x2160]
#include <CLI/CLI.hpp>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "trace_runner.hpp"

namespace pfvox::bench {
namespace {

using Json = nlohmann::ordered_json;

struct Options {
    std::vector<std::string> scenes{"sphere", "shell", "terrain"};
    std::string device;
    std::string size = "3840x2160";
    bool validate = false;
    TraceSettings settings;
};

Json jsonOf(const TraceScene& scene, const gpu::SceneStatistics& s, const gpu::DeviceInfo& device) {
    std::uint64_t octreeBytes = 0;
    for (const OctreeModel& model : scene.asset.models)
        octreeBytes += statistics(model, scene.asset.materials.size()).gpuBytes;
    return {{"scene", scene.name},        {"device", device.name},    {"driver", device.driver},
            {"voxels", s.voxels},         {"instances", s.instances}, {"nodeBytes", s.nodeBytes},
            {"valueBytes", s.valueBytes}, {"bytes", s.totalBytes()},  {"octreeBytes", octreeBytes},
            {"buildMs", s.buildMs}};
}

Json jsonOf(const std::string& scene, const TraceRow& row) {
    return {{"scene", scene},
            {"camera", row.camera},
            {"rays", row.rays},
            {"way", row.way},
            {"casts", row.casts},
            {"ms", row.ms},
            {"Mrays/s", row.megaraysPerSecond()},
            {"hitFraction", row.hitFraction},
            {"stepsPerRay", row.stepsPerRay},
            {"stepLimitReached", row.stepLimitReached},
            {"differing", row.differing}};
}

Result<void> run(const Options& options) {
    PFVOX_TRY(gpu::Device, device,
              gpu::Device::open({.selector = options.device, .validation = options.validate}));
    PFVOX_TRY(TraceRunner, runner, TraceRunner::create(device, options.settings));
    for (const std::string& what : options.scenes) {
        PFVOX_TRY(const TraceScene, source, makeTraceScene(what));
        DiagnosticList diagnostics;
        const gpu::ScenePart part{.asset = &source.asset};
        PFVOX_TRY(const gpu::Scene, scene, gpu::Scene::build(device, {&part, 1}, diagnostics));
        std::cout << jsonOf(source, scene.statistics(), device.info()).dump() << std::endl;
        for (const TraceCamera& camera : source.cameras) {
            PFVOX_TRY(const std::vector<TraceRow>, rows, runner.run(scene, camera, source.singleModel));
            for (const TraceRow& row : rows) std::cout << jsonOf(source.name, row).dump() << std::endl;
        }
    }
    for (const std::string& message : device.validationMessages()) std::cerr << message << '\n';
    if (!device.validationMessages().empty())
        return fail(ErrorCode::Internal, "the validation layer has something to say");
    return {};
}

int main(int argc, char** argv) {
    Options options;
    CLI::App app("Ray casting speed on the GPU, as JSON lines.");
    app.add_option("scenes", options.scenes, "sphere, shell, terrain, landscape, tiny or PF_VOX files");
    app.add_option("--device", options.device, "index or part of the name");
    app.add_option("--size", options.size, "WxH, multiples of 16 and 8");
    app.add_option("--repetitions", options.settings.repetitions, "timed submissions; their median counts");
    app.add_option("--launches", options.settings.launchesPerSubmission, "launches of a submission");
    app.add_option("--warm-up", options.settings.warmUpMs, "milliseconds of launches before these");
    app.add_option("--groups", options.settings.persistentGroups, "workgroups of a persistent launch");
    app.add_option("--refill", options.settings.refill, "idle lanes that are worth a refill");
    app.add_option("--batch", options.settings.batch, "steps between looks for idle lanes");
    std::string spirv;
    app.add_option("--spirv", spirv, "another build of bench_trace.comp, to compare")
        ->check(CLI::ExistingFile);
    app.add_flag("--validate", options.validate, "with the validation layer");
    CLI11_PARSE(app, argc, argv);
    if (std::sscanf(options.size.c_str(), "%ux%u", &options.settings.width, &options.settings.height) != 2 ||
        options.settings.width % 16 != 0 || options.settings.height % 8 != 0 ||
        options.settings.width * options.settings.height == 0) {
        std::cerr << "bench_trace: --size needs WxH, multiples of 16 and 8\n";
        return 2;
    }
    if (!spirv.empty()) {
        std::ifstream file(spirv, std::ios::binary);
        std::uint32_t word = 0;
        while (file.read(reinterpret_cast<char*>(&word), sizeof word)) options.settings.spirv.push_back(word);
    }
    const Result<void> done = run(options);
    if (done) return 0;
    std::cerr << "bench_trace: " << describe(done.error()) << '\n';
    return 1;
}

}  // namespace
}  // namespace pfvox::bench

int main(int argc, char** argv) {
    return pfvox::bench::main(argc, argv);
}
