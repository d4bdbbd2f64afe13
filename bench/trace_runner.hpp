// Runs shaders/bench_trace.comp: one launch for each kind of ray, way of tracing and camera, timed by the
// device.
#pragma once

#include <array>
#include <optional>
#include <pfvox/gpu.hpp>
#include <pfvox/gpu_scene.hpp>
#include <string>
#include <vector>

#include "shared/bench.glsl.h"
#include "trace_scenes.hpp"

namespace pfvox::bench {

struct TraceSettings {
    std::uint32_t width = 3840;   ///< a multiple of 16
    std::uint32_t height = 2160;  ///< a multiple of 8
    double warmUpMs = 150.0;      ///< of launches before the timed ones: clocks fall while the device waits
    int repetitions = 15;         ///< timed submissions; their median counts
    std::size_t launchesPerSubmission = 4;
    std::uint32_t persistentGroups = 132 * 16;
    std::uint32_t refill = 10;
    std::uint32_t batch = 4;
    std::vector<std::uint32_t> bounces{1, 3};
    std::vector<std::uint32_t>
        spirv;  ///< another build of bench_trace.comp, to compare; empty = the built-in one
};

/// One line of the table.
struct TraceRow {
    std::string camera;
    std::string rays;  ///< "primary", "shadow", "diffuse", "diffuse-3"
    std::string way;   ///< "geometry", "scene", each also "-persistent"
    std::uint64_t casts = 0;
    double ms = 0.0;  ///< median
    double hitFraction = 0.0;
    double stepsPerRay = 0.0;
    std::uint64_t stepLimitReached = 0;
    std::uint64_t differing = 0;  ///< persistent: results that are not those of one ray an invocation
    double megaraysPerSecond() const { return ms > 0.0 ? static_cast<double>(casts) / ms * 1e-3 : 0.0; }
};

class TraceRunner {
  public:
    static Result<TraceRunner> create(gpu::Device& device, const TraceSettings& settings);

    /// All rows of one scene and camera.
    Result<std::vector<TraceRow>> run(const gpu::Scene& scene, const TraceCamera& camera, bool singleModel);

  private:
    enum Path : std::uint32_t { Geometry = shared::kBenchGeometry, Whole = shared::kBenchScene };
    struct Variant {
        std::uint32_t kind = 0;
        std::uint32_t path = 0;
        bool persistent = false;
        bool count = false;
    };

    TraceRunner(gpu::Device& device, const TraceSettings& settings, std::vector<gpu::Buffer> buffers)
        : device_(&device), settings_(settings), buffers_(std::move(buffers)) {}

    Result<const gpu::Program*> program(const Variant& variant);
    Result<double> launch(const Variant& variant, const shared::BenchParameters& parameters,
                          std::size_t times = 1);
    Result<double> medianMs(const Variant& variant, const shared::BenchParameters& parameters);
    Result<void> poison();
    Result<std::vector<std::uint32_t>> results(std::uint32_t rayCount);
    Result<TraceRow> measure(Variant variant, shared::BenchParameters parameters);
    Result<std::uint32_t> makeOrigins(shared::BenchParameters parameters, bool useFaces);
    shared::BenchParameters parametersOf(const gpu::Scene& scene, const TraceCamera& camera) const;

    gpu::Device* device_;
    TraceSettings settings_;
    std::vector<gpu::Buffer> buffers_;  ///< origins, normals, results, counters
    std::array<std::optional<gpu::Program>, 64> programs_;
};

}  // namespace pfvox::bench
