#include "bake/probe_tracer.hpp"

#include <bit>
#include <chrono>
#include <cmath>
#include <pfvox/probe_maths.hpp>
#include <pfvox_shaders/shaders.hpp>

namespace pfvox::bake {

namespace {

constexpr std::size_t kMostItems = 4096;
/// llvmpipe seems to bound the loops of an invocation: docs/decisions/013-baker.md.
constexpr std::uint32_t kSoftwareSamplesPerRun = 1;

class Stopwatch {
  public:
    double seconds() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - started_).count();
    }

  private:
    std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now();
};

shared::BakeScene sceneRecord(const gpu::Scene& scene, const TracerInput& input, const BakeSettings& settings,
                              const gpu::Buffer& emitters) {
    return {.scene = scene.address(),
            .emitters = emitters.addressWords(),
            .emitterCount = static_cast<std::uint32_t>(input.emitters.faces.size()),
            .emitterPower = input.emitters.power,
            .maxBounces = std::min(settings.maxBounces.value_or(shared::kMaxPathBounces), shared::kMaxPathBounces),
            .sampling = static_cast<std::uint32_t>(settings.sampling),
            .sunDirection = glm::vec3(glm::normalize(input.sun.direction)),
            .seedLow = static_cast<std::uint32_t>(settings.seed),
            .sunIrradiance = glm::vec3(input.sun.irradiance),
            .seedHigh = static_cast<std::uint32_t>(settings.seed >> 32),
            .skyZenith = glm::vec3(input.sky.zenith),
            .reserved0 = 0,
            .skyHorizon = glm::vec3(input.sky.horizon),
            .reserved1 = 0,
            .skyGround = glm::vec3(input.sky.ground),
            .reserved2 = 0};
}

}  // namespace

TracedEdges tracedEdges(const ProbeResolution& resolution) {
    const std::uint32_t depth = resolution.depth;
    const std::uint32_t light = resolution.light;
    if (depth != 0 && light != 0) return {depth, light};
    if (depth == 0) return {std::max(128u, light), light != 0 ? light : 64u};
    const std::uint32_t block = depth % 32 == 0 ? 4 : 2;  // depth is a multiple of 16, light must be one of 8
    return {depth, depth / block};
}

void ProbeTracer::Pace::took(std::size_t size, double seconds, double target) {
    const double fitting = static_cast<double>(size) * 0.7 * target / std::max(seconds, 1e-6);
    const double grown = std::clamp(fitting, 1.0, 4.0 * static_cast<double>(size_));
    size_ = std::min(static_cast<std::size_t>(grown), most_);
}

Result<ProbeTracer::Buffers> ProbeTracer::createBuffers(gpu::Device& device, const TracerInput& input,
                                                        const TracedEdges& edges) {
    const std::uint64_t faces = std::max<std::uint64_t>(input.emitters.faces.size(), 1);
    const std::uint64_t texels = std::uint64_t{edges.depth} * edges.depth;
    PFVOX_TRY(gpu::Buffer, scene, device.createBuffer(sizeof(shared::BakeScene), "bake scene"));
    PFVOX_TRY(gpu::Buffer, emitters, device.createBuffer(faces * sizeof(shared::EmitterFace), "emitters"));
    PFVOX_TRY(gpu::Buffer, seen, device.createBuffer(texels * sizeof(shared::SeenTexel), "seen texels"));
    PFVOX_TRY(gpu::Buffer, items, device.createBuffer(kMostItems * sizeof(LightItem), "light items"));
    PFVOX_TRY(gpu::Buffer, sums,
              device.createBuffer(kMostItems * shared::kTileTexels * sizeof(glm::vec4), "light sums"));
    PFVOX_TRY(gpu::Buffer, counters, device.createBuffer(sizeof(shared::BakeCounters), "bake counters"));
    if (!input.emitters.faces.empty())
        PFVOX_CHECK(device.upload(emitters, 0, std::as_bytes(std::span(input.emitters.faces))));
    PFVOX_CHECK(device.upload(counters, 0, gpu::bytesOf(shared::BakeCounters{})));
    return Buffers{std::move(scene), std::move(emitters), std::move(seen),
                   std::move(items), std::move(sums),     std::move(counters)};
}

Result<ProbeTracer> ProbeTracer::create(gpu::Device& device, const gpu::Scene& scene, const TracerInput& input,
                                        const BakeSettings& settings) {
    const bool software = device.info().kind == gpu::DeviceKind::Software;
    const std::uint32_t samplesPerRun = software ? kSoftwareSamplesPerRun : shared::kBatchSamples;
    const std::uint32_t constants[] = {input.hasGlass ? 1u : 0u, samplesPerRun};
    PFVOX_TRY(gpu::Program, geometry,
              device.createProgram(shaders::kBakeGeometry, sizeof(shared::GeometryPush), "bake geometry",
                                   std::span(constants).first(1)));
    PFVOX_TRY(gpu::Program, light,
              device.createProgram(shaders::kBakeLight, sizeof(shared::LightPush), "bake light", constants));
    const TracedEdges edges = tracedEdges(settings.resolution);
    PFVOX_TRY(Buffers, buffers, createBuffers(device, input, edges));
    PFVOX_CHECK(device.upload(buffers.scene, 0,
                              gpu::bytesOf(sceneRecord(scene, input, settings, buffers.emitters))));
    ProbeTracer tracer(device, std::move(geometry), std::move(light), std::move(buffers));
    tracer.edges_ = edges;
    tracer.samplesPerRun_ = samplesPerRun;
    tracer.depth_ = input.depth;
    tracer.rules_ = {.minBatches = settings.minSamples / shared::kBatchSamples,
                     .maxBatches = settings.maxSamples / shared::kBatchSamples,
                     .noiseTarget = static_cast<double>(settings.noiseTarget),
                     .noiseFloor = static_cast<double>(settings.noiseFloor)};
    tracer.dispatchSeconds_ = settings.dispatchSeconds;
    return tracer;
}

Result<std::vector<shared::SeenTexel>> ProbeTracer::see(const glm::vec3& position, const WorkDone& done) {
    const glm::vec2 coding = DepthCoder(depth_).scaleAndLogRange();
    const std::uint32_t texels = edges_.depth * edges_.depth;
    shared::GeometryPush push{.scene = buffers_.scene.addressWords(),
                              .texels = buffers_.texels.addressWords(),
                              .probe = position,
                              .edge = edges_.depth,
                              .depthScale = coding.x,
                              .depthLogRange = coding.y,
                              .firstTexel = 0,
                              .texelCount = 0,
                              .counters = buffers_.counters.addressWords(),
                              .reserved0 = {0, 0}};
    for (std::uint32_t first = 0; first < texels; first += push.texelCount) {
        push.firstTexel = first;
        push.texelCount = std::min(texels - first, static_cast<std::uint32_t>(geometryPace_.size()) * shared::kBakeGroupSize);
        const std::uint32_t groups = (push.texelCount + shared::kBakeGroupSize - 1) / shared::kBakeGroupSize;
        const gpu::Dispatch dispatch{
            .program = &geometry_, .pushConstants = gpu::bytesOf(push), .groups = {groups, 1, 1}};
        const Stopwatch watch;
        PFVOX_TRY(const double, gpuMs, device_->run({&dispatch, 1}));
        geometryPace_.took(groups, watch.seconds(), dispatchSeconds_);
        PFVOX_CHECK(done({.rays = push.texelCount, .gpuMs = gpuMs}));
    }
    std::vector<shared::SeenTexel> seen(texels);
    PFVOX_CHECK(device_->download(buffers_.texels, 0, std::as_writable_bytes(std::span(seen))));
    return seen;
}

Result<double> ProbeTracer::runBatches(std::span<const LightItem> items, const shared::LightPush& push,
                                       std::vector<glm::vec4>& sums, std::uint64_t& rays) {
    sums.assign(items.size() * shared::kTileTexels, glm::vec4(0.0f));
    std::vector<glm::vec4> results(sums.size());
    std::vector<glm::uvec2> starts(items.size());
    const gpu::Dispatch dispatch{.program = &light_,
                                 .pushConstants = gpu::bytesOf(push),
                                 .groups = {static_cast<std::uint32_t>(items.size()), 1, 1}};
    double gpuMs = 0.0;
    for (std::uint32_t first = 0; first < shared::kBatchSamples; first += samplesPerRun_) {
        for (std::size_t i = 0; i < items.size(); ++i)
            starts[i] = {items[i].tile, items[i].batch * shared::kBatchSamples + first};
        PFVOX_CHECK(device_->upload(buffers_.items, 0, std::as_bytes(std::span(starts))));
        PFVOX_TRY(const double, ms, device_->run({&dispatch, 1}));
        gpuMs += ms;
        PFVOX_CHECK(device_->download(buffers_.sums, 0, std::as_writable_bytes(std::span(results))));
        for (std::size_t i = 0; i < results.size(); ++i) {
            sums[i] += glm::vec4(glm::vec3(results[i]), 0.0f);
            rays += std::bit_cast<std::uint32_t>(results[i].w);
        }
    }
    return gpuMs;
}

Result<void> ProbeTracer::runItems(std::span<const LightItem> items, const shared::LightPush& push, TileSums& sums,
                                   const WorkDone& done) {
    std::vector<glm::vec4> results;
    for (std::size_t first = 0; first < items.size();) {
        const auto part = items.subspan(first, std::min(items.size() - first, lightPace_.size()));
        const Stopwatch watch;
        std::uint64_t rays = 0;
        PFVOX_TRY(const double, gpuMs, runBatches(part, push, results, rays));
        const double runs = double{shared::kBatchSamples} / samplesPerRun_;
        lightPace_.took(part.size(), watch.seconds() / runs, dispatchSeconds_);
        for (std::size_t i = 0; i < part.size(); ++i)
            sums.add(part[i], std::span(results).subspan(i * shared::kTileTexels, shared::kTileTexels));
        PFVOX_CHECK(done({.rays = rays, .gpuMs = gpuMs}));
        first += part.size();
    }
    return {};
}

Result<TileSums> ProbeTracer::light(std::uint32_t probe, const glm::vec3& position,
                                    std::span<const shared::SeenTexel> seen, const WorkDone& done) {
    const std::uint32_t block = edges_.depth / edges_.light;
    std::vector<bool> seesSurface(std::size_t{edges_.light} * edges_.light);
    for (std::uint32_t y = 0; y < edges_.depth; ++y)
        for (std::uint32_t x = 0; x < edges_.depth; ++x)
            if (seen[x + std::size_t{edges_.depth} * y].metres >= 0.0f)
                seesSurface[x / block + std::size_t{edges_.light} * (y / block)] = true;
    TileSums sums(edges_.light, seesSurface, rules_);
    const shared::LightPush push{.scene = buffers_.scene.addressWords(),
                                 .texels = buffers_.texels.addressWords(),
                                 .probe = position,
                                 .depthEdge = edges_.depth,
                                 .items = buffers_.items.addressWords(),
                                 .sums = buffers_.sums.addressWords(),
                                 .lightEdge = edges_.light,
                                 .probeIndex = probe,
                                 .counters = buffers_.counters.addressWords()};
    for (auto items = sums.nextRound(); !items.empty(); items = sums.nextRound())
        PFVOX_CHECK(runItems(items, push, sums, done));
    return sums;
}

Result<std::uint64_t> ProbeTracer::cappedRays() {
    shared::BakeCounters counters{};
    PFVOX_CHECK(device_->download(buffers_.counters, 0, std::as_writable_bytes(std::span(&counters, 1))));
    return counters.cappedRays;
}

}  // namespace pfvox::bake
