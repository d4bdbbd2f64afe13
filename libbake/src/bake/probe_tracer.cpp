#include "bake/probe_tracer.hpp"

#include <fmt/format.h>

#include <array>
#include <chrono>
#include <cmath>
#include <pfvox/assert.hpp>
#include <pfvox/probe_maths.hpp>
#include <pfvox_shaders/shaders.hpp>

namespace pfvox::bake {

namespace {

constexpr std::uint64_t kMostGroup = 64;
constexpr std::uint64_t kMostSoftwareGroup = 4;
/// Probes of a group bring this many waves of paths, so that what is done once a group does not count.
constexpr std::uint64_t kWavesPerGroup = 4;

std::uint64_t mapWords(const TracedResolution& resolution) {
    return 2ull * resolution.depth * resolution.depth + 7ull * resolution.light * resolution.light;
}

std::uint64_t bytesPerProbe(const TracedResolution& resolution) {
    const std::uint64_t light = std::uint64_t{resolution.light} * resolution.light;
    return std::uint64_t{resolution.depth} * resolution.depth * sizeof(shared::SeenTexel) +
           light * sizeof(glm::vec4) + light / shared::kTileTexels * sizeof(shared::TileStatistics) +
           mapWords(resolution) * sizeof(std::uint32_t);
}

/// Enough for full waves, in an eighth of the device's memory; few on a software device, so that a kill loses
/// little.
std::uint32_t groupFor(const gpu::DeviceInfo& device, const TracedResolution& resolution,
                       const BakeSettings& settings, std::uint64_t wavePaths) {
    const bool software = device.kind == gpu::DeviceKind::Software;
    const std::uint64_t paths = std::uint64_t{resolution.light} * resolution.light * settings.minSamples;
    const std::uint64_t wanted = (software ? 1 : kWavesPerGroup) * wavePaths / paths;
    const std::uint64_t memory =
        std::min(software ? std::uint64_t{256} << 20 : ~std::uint64_t{0}, device.localMemoryBytes / 8);
    // Indices of texels and of words of maps have 32 bits.
    const std::uint64_t addressable = 0xffffffffull / mapWords(resolution);
    const std::uint64_t fitting = std::min(memory / bytesPerProbe(resolution), addressable);
    return static_cast<std::uint32_t>(
        std::clamp<std::uint64_t>(std::min(wanted, fitting), 1, software ? kMostSoftwareGroup : kMostGroup));
}

WaveOptions waveOptions(const TracerInput& input, const BakeSettings& settings) {
    const glm::dvec3& sun = input.sun.irradiance;
    return {.hasGlass = input.hasGlass,
            .hasSun = std::max({sun.x, sun.y, sun.z}) > 0.0,
            .hasEmitters = !input.emitters.faces.empty() && settings.sampling != LightSampling::Directions,
            .stratified = settings.stratified,
            .maxBounces =
                std::min(settings.maxBounces.value_or(shared::kMaxPathBounces), shared::kMaxPathBounces),
            .submitSeconds = settings.dispatchSeconds};
}

template <class T>
Result<void> fill(gpu::Device& device, const gpu::Buffer& source, std::uint64_t& at, std::size_t count,
                  std::vector<T>& values) {
    values.resize(count);
    const std::uint64_t from = at;
    at += count * sizeof(T);
    return device.download(source, from, std::as_writable_bytes(std::span(values)));
}

}  // namespace

TracedResolution tracedResolution(const ProbeResolution& resolution) {
    const std::uint32_t depth = resolution.depth;
    const std::uint32_t light = resolution.light;
    if (depth != 0 && light != 0) return {depth, light};
    if (depth == 0) return {std::max(128u, light), light != 0 ? light : 64u};
    const std::uint32_t block = depth % 32 == 0 ? 4 : 2;  // depth is a multiple of 16, light must be one of 8
    return {depth, depth / block};
}

Result<ProbeTracer::Programs> ProbeTracer::createPrograms(gpu::Device& device, bool hasGlass) {
    const std::uint32_t glass = hasGlass ? 1 : 0;
    const std::array resetting{glass, 1u};
    const auto create = [&](std::span<const std::uint32_t> spirv, std::string_view name,
                            std::span<const std::uint32_t> constants) {
        return device.createProgram(spirv, sizeof(shared::WavePush), name, constants);
    };
    const auto onlyGlass = std::span(resetting).first(1);
    PFVOX_TRY(gpu::Program, geometry, create(shaders::kBakeGeometry, "bake geometry", onlyGlass));
    PFVOX_TRY(gpu::Program, resetTiles, create(shaders::kBakeTiles, "bake reset tiles", resetting));
    PFVOX_TRY(gpu::Program, tiles, create(shaders::kBakeTiles, "bake tiles", onlyGlass));
    PFVOX_TRY(gpu::Program, finish, create(shaders::kBakeFinish, "bake finish", onlyGlass));
    PFVOX_TRY(gpu::Program, faces, create(shaders::kBakeFaces, "bake light of faces", onlyGlass));
    return Programs{std::move(geometry), std::move(resetTiles), std::move(tiles), std::move(finish),
                    std::move(faces)};
}

Result<ProbeTracer::Buffers> ProbeTracer::createBuffers(gpu::Device& device,
                                                        const TracedResolution& resolution,
                                                        std::uint32_t probes) {
    const std::uint64_t texels = std::uint64_t{probes} * resolution.depth * resolution.depth;
    const std::uint64_t light = std::uint64_t{probes} * resolution.light * resolution.light;
    const std::uint64_t tiles = light / shared::kTileTexels;
    PFVOX_TRY(gpu::Buffer, wave, device.createBuffer(sizeof(shared::BakeWave), "bake wave"));
    PFVOX_TRY(gpu::Buffer, places, device.createBuffer(probes * sizeof(shared::BakeProbe), "probes"));
    PFVOX_TRY(gpu::Buffer, seen, device.createBuffer(texels * sizeof(shared::SeenTexel), "seen texels"));
    PFVOX_TRY(gpu::Buffer, sums, device.createBuffer(light * sizeof(glm::vec4), "light sums"));
    PFVOX_TRY(gpu::Buffer, noise, device.createBuffer(tiles * sizeof(shared::TileStatistics), "tiles"));
    PFVOX_TRY(gpu::Buffer, maps,
              device.createBuffer(probes * mapWords(resolution) * sizeof(std::uint32_t), "maps"));
    return Buffers{std::move(wave), std::move(places), std::move(seen),
                   std::move(sums), std::move(noise),  std::move(maps)};
}

Result<ProbeTracer> ProbeTracer::create(gpu::Device& device, const gpu::Scene& scene,
                                        const TracerInput& input, const BakeSettings& settings) {
    std::uint64_t items = PathWaves::itemsFor(device.info());
    for (;;) {
        auto tracer = createFor(device, scene, input, settings, items);
        if (tracer || tracer.error().code != ErrorCode::GpuOutOfMemory) return tracer;
        if (items >
            PathWaves::kLeastItems) {  // others may have taken the memory: smaller pieces give the same light
            items = std::max(items / 4, PathWaves::kLeastItems);
            continue;
        }
        const std::uint64_t needed = bytesPerProbe(tracedResolution(settings.resolution)) +
                                     PathWaves::bytesFor(items * shared::kItemPaths) +
                                     input.emitters.faces.size() * sizeof(shared::EmitterFace);
        tracer.error().message +=
            fmt::format("; the bake needs {} MiB of device memory beside {} MiB for the scene",
                        (needed >> 20) + 1, device.memory().currentBytes >> 20);
        return tracer;
    }
}

Result<ProbeTracer> ProbeTracer::createFor(gpu::Device& device, const gpu::Scene& scene,
                                           const TracerInput& input, const BakeSettings& settings,
                                           std::uint64_t items) {
    const TracedResolution resolution = tracedResolution(settings.resolution);
    PFVOX_TRY(Programs, programs, createPrograms(device, input.hasGlass));
    PFVOX_TRY(PathWaves, waves, PathWaves::create(device, waveOptions(input, settings), items));
    const std::uint32_t group = groupFor(device.info(), resolution, settings, waves.mostPaths());
    PFVOX_TRY(BakeSceneBuffers, bakeScene,
              BakeSceneBuffers::create(device, scene, input.sun, input.sky, input.emitters, settings));
    PFVOX_TRY(Buffers, buffers, createBuffers(device, resolution, group));
    const glm::vec2 coding = DepthCoder(input.depth).scaleAndLogRange();
    shared::BakeWave wave{};
    wave.scene = bakeScene.address();
    wave.probes = buffers.probes.addressWords();
    wave.texels = buffers.texels.addressWords();
    wave.sums = buffers.sums.addressWords();
    wave.tiles = buffers.tiles.addressWords();
    wave.maps = buffers.maps.addressWords();
    wave.depthResolution = resolution.depth;
    wave.lightResolution = resolution.light;
    wave.depthScale = coding.x;
    wave.depthLogRange = coding.y;
    waves.describe(wave);
    PFVOX_CHECK(device.upload(buffers.wave, 0, gpu::bytesOf(wave)));
    ProbeTracer tracer(device, std::move(waves), std::move(bakeScene), std::move(programs),
                       std::move(buffers));
    tracer.resolution_ = resolution;
    tracer.groupSize_ = group;
    tracer.rules_ = {.minBatches = settings.minSamples / shared::kBatchSamples,
                     .maxBatches = settings.maxSamples / shared::kBatchSamples,
                     .noiseTarget = static_cast<double>(settings.noiseTarget),
                     .noiseFloor = static_cast<double>(settings.noiseFloor)};
    tracer.faces_ = input.faces;
    tracer.submitSeconds_ = settings.dispatchSeconds;
    return tracer;
}

Result<double> ProbeTracer::run(const gpu::Program& program, std::uint32_t first, std::uint32_t count,
                                std::uint32_t perGroup) {
    const shared::WavePush push{.wave = buffers_.wave.addressWords(),
                                .first = first,
                                .count = count,
                                .set = 0,
                                .reserved0 = 0,
                                .faces = faces_ != nullptr ? faces_->address() : glm::uvec2(0)};
    const std::uint32_t groups = (count + perGroup - 1) / perGroup;
    const gpu::Dispatch dispatch{
        .program = &program,
        .pushConstants = gpu::bytesOf(push),
        .groups = {std::min(groups, shared::kBakeRowGroups),
                   (groups + shared::kBakeRowGroups - 1) / shared::kBakeRowGroups, 1}};
    return device_->run({&dispatch, 1});
}

Result<void> ProbeTracer::see(std::span<const shared::BakeProbe> probes, const WorkDone& done) {
    probeCount_ = static_cast<std::uint32_t>(probes.size());
    finished_ = false;
    PFVOX_CHECK(device_->upload(buffers_.probes, 0, std::as_bytes(probes)));
    const std::uint32_t texels = probeCount_ * resolution_.depth * resolution_.depth;
    for (std::uint32_t first = 0; first < texels;) {
        const auto groups = static_cast<std::uint32_t>(geometryPace_.size());
        const std::uint32_t count = std::min(texels - first, groups * shared::kBakeGroupSize);
        const auto started = std::chrono::steady_clock::now();
        PFVOX_TRY(const double, gpuMs, run(programs_.geometry, first, count, shared::kBakeGroupSize));
        const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - started;
        geometryPace_.took((count + shared::kBakeGroupSize - 1) / shared::kBakeGroupSize, seconds.count(),
                           submitSeconds_);
        PFVOX_CHECK(done({.rays = count, .gpuMs = gpuMs}));
        first += count;
    }
    PFVOX_TRY(std::vector<shared::TileStatistics>, judged, judgeTiles(programs_.resetTiles));
    judged_ = std::move(judged);
    return {};
}

Result<std::vector<shared::TileStatistics>> ProbeTracer::judgeTiles(const gpu::Program& program) {
    const std::uint32_t tiles = probeCount_ * tilesPerProbe();
    PFVOX_TRY(const double, gpuMs, run(program, 0, tiles, 1));
    static_cast<void>(gpuMs);
    std::vector<shared::TileStatistics> judged(tiles);
    PFVOX_CHECK(device_->download(buffers_.tiles, 0, std::as_writable_bytes(std::span(judged))));
    return judged;
}

Result<void> ProbeTracer::light(const WorkDone& done) {
    if (faces_ != nullptr) {
        PFVOX_TRY(const double, gpuMs, run(programs_.faces, 0, probeCount_ * tilesPerProbe(), 1));
        PFVOX_CHECK(done(
            {.rays = std::uint64_t{probeCount_} * resolution_.depth * resolution_.depth, .gpuMs = gpuMs}));
    }
    while (faces_ == nullptr) {
        std::vector<TileWork> work;
        for (std::uint32_t tile = 0; tile < judged_.size(); ++tile) {
            const std::uint32_t more = moreBatches(judged_[tile], rules_);
            if (more != 0)
                work.push_back({.tile = tile, .firstBatch = judged_[tile].batches, .batches = more});
        }
        if (work.empty()) break;
        PFVOX_CHECK(waves_.trace(work, buffers_.wave.addressWords(), done));
        PFVOX_TRY(std::vector<shared::TileStatistics>, judged, judgeTiles(programs_.tiles));
        judged_ = std::move(judged);
    }
    const std::uint32_t texels = probeCount_ * resolution_.light * resolution_.light;
    PFVOX_TRY(const double, gpuMs, run(programs_.finish, 0, texels, shared::kBakeGroupSize));
    static_cast<void>(gpuMs);
    finished_ = true;
    return {};
}

Result<TracedProbe> ProbeTracer::collect(std::uint32_t probe) {
    PFVOX_ASSERT(finished_ && probe < probeCount_);
    TracedProbe traced;
    traced.resolution = resolution_;
    const std::size_t depth = std::size_t{resolution_.depth} * resolution_.depth;
    const std::size_t light = std::size_t{resolution_.light} * resolution_.light;
    std::uint64_t at = probe * mapWords(resolution_) * sizeof(std::uint32_t);
    PFVOX_CHECK(fill(*device_, buffers_.maps, at, depth, traced.words));
    PFVOX_CHECK(fill(*device_, buffers_.maps, at, depth, traced.metres));
    PFVOX_CHECK(fill(*device_, buffers_.maps, at, light, traced.light));
    PFVOX_CHECK(fill(*device_, buffers_.maps, at, light, traced.errors));
    PFVOX_CHECK(fill(*device_, buffers_.maps, at, light, traced.leaving));
    const auto tiles =
        std::span<const shared::TileStatistics>(judged_).subspan(probe * tilesPerProbe(), tilesPerProbe());
    traced.tiles = summaryOf(tiles, rules_);
    return traced;
}

Result<std::vector<shared::SeenTexel>> ProbeTracer::seenTexels(std::uint32_t probe) {
    PFVOX_ASSERT(probe < probeCount_);
    const std::size_t texels = std::size_t{resolution_.depth} * resolution_.depth;
    std::vector<shared::SeenTexel> seen(texels);
    PFVOX_CHECK(device_->download(buffers_.texels, probe * texels * sizeof(shared::SeenTexel),
                                  std::as_writable_bytes(std::span(seen))));
    return seen;
}

Result<std::uint64_t> ProbeTracer::stepLimitRays() {
    return waves_.stepLimitRays();
}

}  // namespace pfvox::bake
