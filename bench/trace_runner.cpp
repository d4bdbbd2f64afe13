#include "trace_runner.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <pfvox_check_shaders/shaders.hpp>

namespace pfvox::bench {

namespace {

enum : std::size_t { kOrigins, kNormals, kResults, kCounters };

glm::vec3 toFloat(glm::dvec3 v) {
    return glm::vec3(v);
}

}  // namespace

Result<TraceRunner> TraceRunner::create(gpu::Device& device, const TraceSettings& settings) {
    const std::uint64_t pixels = std::uint64_t{settings.width} * settings.height;
    std::vector<gpu::Buffer> buffers;
    for (const auto& [bytes, name] :
         {std::pair{16 * pixels, "origins"}, std::pair{16 * pixels, "normals"},
          std::pair{8 * pixels, "results"}, std::pair{sizeof(shared::BenchCounters), "counters"}}) {
        PFVOX_TRY(gpu::Buffer, buffer, device.createBuffer(bytes, name));
        buffers.push_back(std::move(buffer));
    }
    return TraceRunner(device, settings, std::move(buffers));
}

Result<const gpu::Program*> TraceRunner::program(const Variant& v) {
    const std::size_t index = v.kind + 8 * v.path + (v.persistent ? 16 : 0) + (v.count ? 32 : 0);
    if (!programs_[index]) {
        const std::array constants{v.kind, v.path, v.persistent ? 1u : 0u, v.count ? 1u : 0u};
        PFVOX_TRY(gpu::Program, made,
                  device_->createProgram(settings_.spirv.empty() ? shaders::kBenchTrace : settings_.spirv,
                                         sizeof(shared::BenchParameters), "bench", constants));
        programs_[index] = std::move(made);
    }
    return &*programs_[index];
}

shared::BenchParameters TraceRunner::parametersOf(const gpu::Scene& scene, const TraceCamera& camera) const {
    const glm::dvec3 forward = glm::normalize(camera.target - camera.eye);
    const glm::dvec3 right = glm::normalize(glm::cross(forward, glm::dvec3(0, 1, 0)));
    const glm::dvec3 up = glm::cross(right, forward);
    const double tanY = std::tan(glm::radians(0.5 * camera.fovYDegrees));
    const double tanX = tanY * settings_.width / settings_.height;
    return {.scene = scene.address(),
            .origins = buffers_[kOrigins].addressWords(),
            .normals = buffers_[kNormals].addressWords(),
            .results = buffers_[kResults].addressWords(),
            .counters = buffers_[kCounters].addressWords(),
            .width = settings_.width,
            .height = settings_.height,
            .eye = toFloat(camera.eye),
            .rayCount = settings_.width * settings_.height,
            .forward = toFloat(forward),
            .bounces = 1,
            .right = toFloat(tanX * right),
            .batch = settings_.batch,
            .up = toFloat(tanY * up),
            .refill = settings_.refill};
}

/// Milliseconds of one of `times` launches, all in one submission; each begins with fresh counters.
Result<double> TraceRunner::launch(const Variant& variant, const shared::BenchParameters& parameters,
                                   std::size_t times) {
    PFVOX_TRY(const gpu::Program* const, made, program(variant));
    PFVOX_TRY(const gpu::Program* const, reset, program({.kind = shared::kBenchReset}));
    const std::uint32_t all = (parameters.rayCount + shared::kBenchGroupSize - 1) / shared::kBenchGroupSize;
    const gpu::Dispatch resetting{.program = reset, .pushConstants = gpu::bytesOf(parameters)};
    const gpu::Dispatch casting{
        .program = made,
        .pushConstants = gpu::bytesOf(parameters),
        .groups = {variant.persistent ? std::min(all, settings_.persistentGroups) : all, 1, 1}};
    std::vector<gpu::Dispatch> dispatches;
    for (std::size_t i = 0; i < times; ++i) {
        if (variant.persistent || variant.count) dispatches.push_back(resetting);
        dispatches.push_back(casting);
    }
    PFVOX_TRY(const double, ms, device_->run(dispatches));
    return ms / static_cast<double>(times);
}

Result<double> TraceRunner::medianMs(const Variant& variant, const shared::BenchParameters& parameters) {
    for (double warm = 0.0; warm < settings_.warmUpMs;) {
        PFVOX_TRY(const double, ms, launch(variant, parameters, settings_.launchesPerSubmission));
        if (ms <= 0.0) break;  // a device without time stamps
        warm += ms * static_cast<double>(settings_.launchesPerSubmission);
    }
    std::vector<double> times;
    for (int i = 0; i < settings_.repetitions; ++i) {
        PFVOX_TRY(const double, ms, launch(variant, parameters, settings_.launchesPerSubmission));
        times.push_back(ms);
    }
    std::ranges::sort(times);
    return times[times.size() / 2];
}

/// So that a result that nobody writes is seen.
Result<void> TraceRunner::poison() {
    const std::vector<std::uint32_t> poison(buffers_[kResults].sizeBytes() / 4, 0xdeadbeefu);
    return device_->upload(buffers_[kResults], 0, std::as_bytes(std::span(poison)));
}

Result<std::vector<std::uint32_t>> TraceRunner::results(std::uint32_t rayCount) {
    std::vector<std::uint32_t> words(2 * std::size_t{rayCount});
    PFVOX_CHECK(device_->download(buffers_[kResults], 0, std::as_writable_bytes(std::span(words))));
    return words;
}

Result<TraceRow> TraceRunner::measure(Variant variant, shared::BenchParameters parameters) {
    PFVOX_TRY(const double, ms, medianMs(variant, parameters));
    // Counted by one ray an invocation, whatever was timed; what was timed is left in the results.
    shared::BenchCounters counters{};
    Variant counting = variant;
    counting.persistent = false;
    counting.count = true;
    PFVOX_CHECK(launch(counting, parameters));
    PFVOX_CHECK(device_->download(buffers_[kCounters], 0, std::as_writable_bytes(std::span(&counters, 1))));
    PFVOX_CHECK(poison());
    PFVOX_CHECK(launch(variant, parameters));

    static constexpr std::array kKinds{"primary", "shadow", "diffuse"};
    TraceRow row;
    row.rays = kKinds[variant.kind];
    if (parameters.bounces > 1) row.rays += "-" + std::to_string(parameters.bounces);
    row.way = variant.path == Geometry ? "geometry" : "scene";
    if (variant.persistent) row.way += "-persistent";
    row.casts = counters.rays;
    row.ms = ms;
    row.hitFraction = counters.hits / std::max(1.0, static_cast<double>(counters.rays));
    row.stepsPerRay = counters.steps / std::max(1.0, static_cast<double>(counters.rays));
    row.stepLimitReached = counters.stepLimitReached;
    return row;
}

/// Start points of the secondary rays, those of pixels without a hit left out. Returns their number.
Result<std::uint32_t> TraceRunner::makeOrigins(shared::BenchParameters parameters, bool useFaces) {
    PFVOX_CHECK(launch({.kind = shared::kBenchOrigins, .path = Whole}, parameters));
    std::vector<glm::vec4> origins(parameters.rayCount);
    std::vector<glm::vec4> normals(parameters.rayCount);
    PFVOX_CHECK(device_->download(buffers_[kOrigins], 0, std::as_writable_bytes(std::span(origins))));
    PFVOX_CHECK(device_->download(buffers_[kNormals], 0, std::as_writable_bytes(std::span(normals))));
    std::uint32_t count = 0;
    for (std::size_t i = 0; i < origins.size(); ++i) {
        const auto face = std::bit_cast<std::uint32_t>(origins[i].w);
        if (face > 5) continue;  // a miss, or the camera stands in a voxel
        glm::vec4& kept = origins[count] = origins[i];
        normals[count] = normals[i];
        kept.w = std::bit_cast<float>((useFaces ? face : shared::kBenchUseNormal) | count << 3);
        ++count;
    }
    if (count == 0) return 0;
    const auto bytes = [&](std::vector<glm::vec4>& v) { return std::as_bytes(std::span(v).first(count)); };
    PFVOX_CHECK(device_->upload(buffers_[kOrigins], 0, bytes(origins)));
    PFVOX_CHECK(device_->upload(buffers_[kNormals], 0, bytes(normals)));
    return count;
}

Result<std::vector<TraceRow>> TraceRunner::run(const gpu::Scene& scene, const TraceCamera& camera,
                                               bool singleModel) {
    shared::BenchParameters parameters = parametersOf(scene, camera);
    std::vector<TraceRow> rows;
    const auto add = [&](std::uint32_t kind) -> Result<void> {
        for (const std::uint32_t path : {Geometry, Whole}) {
            if (path == Geometry && (!singleModel || parameters.bounces > 1)) continue;
            std::vector<std::uint32_t> expected;
            for (const bool persistent : {false, true}) {
                if (persistent && parameters.bounces > 1) continue;
                PFVOX_TRY(TraceRow, row,
                          measure({.kind = kind, .path = path, .persistent = persistent}, parameters));
                PFVOX_TRY(const std::vector<std::uint32_t>, found, results(parameters.rayCount));
                if (persistent) {
                    for (std::size_t i = 0; i < found.size(); ++i) row.differing += found[i] != expected[i];
                } else {
                    expected = found;
                }
                row.camera = camera.name;
                rows.push_back(std::move(row));
            }
        }
        return {};
    };
    PFVOX_CHECK(add(shared::kBenchPrimary));
    PFVOX_TRY(const std::uint32_t, secondary, makeOrigins(parameters, singleModel));
    if (secondary == 0) return rows;
    parameters.rayCount = secondary;
    PFVOX_CHECK(add(shared::kBenchShadow));
    for (const std::uint32_t bounces : settings_.bounces) {
        parameters.bounces = bounces;
        PFVOX_CHECK(add(shared::kBenchDiffuse));
    }
    return rows;
}

}  // namespace pfvox::bench
