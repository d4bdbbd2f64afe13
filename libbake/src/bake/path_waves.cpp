#include "bake/path_waves.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <pfvox_shaders/shaders.hpp>

namespace pfvox::bake {

namespace {

constexpr std::uint32_t kStepsPerSubmit = 12;
constexpr std::uint64_t kFirstItems = 512;
// Some sixty vertices until the last path of a wave has ended, most of them of few paths: the larger the
// wave, the less these count.
constexpr std::uint64_t kMostItems = 65536;
constexpr std::uint64_t kBytesPerPath = sizeof(shared::PathState) + sizeof(glm::vec4) +
                                        sizeof(shared::PathHit) + 2 * sizeof(shared::ShadowRay) +
                                        2 * sizeof(std::uint32_t);

double secondsSince(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

void Pace::took(std::size_t size, double seconds, double target) {
    const double fitting = static_cast<double>(size) * 0.7 * target / std::max(seconds, 1e-6);
    const double grown = std::clamp(fitting, 1.0, 4.0 * static_cast<double>(size_));
    size_ = std::min(static_cast<std::size_t>(grown), most_);
}

/// Dispatches of one submission; push constants stay where they are until it is done.
class PathWaves::Recording {
  public:
    Recording(glm::uvec2 wave, const gpu::Buffer& control) : wave_(wave), control_(&control) {}

    void groups(const gpu::Program& program, std::uint32_t count, std::uint32_t groupCount,
                std::uint32_t set = 0) {
        const glm::uvec3 groups(std::min(groupCount, shared::kBakeRowGroups),
                                (groupCount + shared::kBakeRowGroups - 1) / shared::kBakeRowGroups, 1);
        add({.program = &program, .groups = groups}, count, set);
    }
    /// As many as the queue of the set needs.
    void queued(const gpu::Program& program, std::uint32_t queue, std::uint32_t set) {
        const std::uint64_t at = offsetof(shared::WaveControl, launch) + 16ull * queue;
        add({.program = &program, .groupsFrom = control_, .groupsAtBytes = at}, 0, set);
    }
    Result<double> run(gpu::Device& device) {
        for (std::size_t i = 0; i < dispatches_.size(); ++i)
            dispatches_[i].pushConstants = gpu::bytesOf(pushes_[i]);
        PFVOX_TRY(const double, gpuMs, device.run(dispatches_));
        dispatches_.clear();
        pushes_.clear();
        return gpuMs;
    }

  private:
    void add(const gpu::Dispatch& dispatch, std::uint32_t count, std::uint32_t set) {
        dispatches_.push_back(dispatch);
        pushes_.push_back(
            {.wave = wave_, .first = 0, .count = count, .set = set, .reserved0 = 0, .faces = glm::uvec2(0)});
    }

    glm::uvec2 wave_;
    const gpu::Buffer* control_;
    std::vector<gpu::Dispatch> dispatches_;
    std::vector<shared::WavePush> pushes_;
};

PathWaves::PathWaves(gpu::Device& device, const WaveOptions& options, Programs programs, Buffers buffers,
                     std::size_t items)
    : device_(&device),
      options_(options),
      programs_(std::move(programs)),
      buffers_(std::move(buffers)),
      mostItems_(items),
      pace_(kFirstItems, items) {}

Result<PathWaves::Programs> PathWaves::createPrograms(gpu::Device& device, const WaveOptions& options) {
    const std::uint32_t glass = options.hasGlass ? 1 : 0;
    const std::array sampling{glass, 0u, 0u, options.stratified ? 2u : 0u};
    const std::array toHits{glass, shared::kQueueRays};
    const std::array toSun{glass, shared::kQueueSun};
    const std::array toEmitters{glass, shared::kQueueEmitters};
    const auto create = [&](std::span<const std::uint32_t> spirv, std::string_view name,
                            std::span<const std::uint32_t> constants) {
        return device.createProgram(spirv, sizeof(shared::WavePush), name, constants);
    };
    const auto onlyGlass = std::span(sampling).first(1);
    PFVOX_TRY(gpu::Program, begin, create(shaders::kBakeBegin, "bake begin", sampling));
    PFVOX_TRY(gpu::Program, rays, create(shaders::kBakeCast, "bake cast rays", toHits));
    PFVOX_TRY(gpu::Program, scatter, create(shaders::kBakeScatter, "bake scatter", sampling));
    PFVOX_TRY(gpu::Program, queue, create(shaders::kBakeQueue, "bake queue", onlyGlass));
    PFVOX_TRY(gpu::Program, sun, create(shaders::kBakeCast, "bake cast to the sun", toSun));
    PFVOX_TRY(gpu::Program, emitters, create(shaders::kBakeCast, "bake cast to emitters", toEmitters));
    PFVOX_TRY(gpu::Program, gather, create(shaders::kBakeGather, "bake gather", onlyGlass));
    return Programs{std::move(begin), std::move(rays),     std::move(scatter), std::move(queue),
                    std::move(sun),   std::move(emitters), std::move(gather)};
}

std::uint64_t PathWaves::bytesFor(std::uint64_t paths) {
    return paths * kBytesPerPath;
}

Result<PathWaves::Buffers> PathWaves::createBuffers(gpu::Device& device, std::uint64_t items) {
    const std::uint64_t paths = items * shared::kItemPaths;
    const auto create = [&](std::uint64_t sizeBytes, std::string_view name) {
        return device.createBuffer(sizeBytes, name);
    };
    PFVOX_TRY(gpu::Buffer, itemList, create(items * sizeof(glm::uvec2), "light items"));
    PFVOX_TRY(gpu::Buffer, runs, create(items * sizeof(shared::GatherRun), "light runs"));
    PFVOX_TRY(gpu::Buffer, states, create(paths * sizeof(shared::PathState), "paths"));
    PFVOX_TRY(gpu::Buffer, arrived, create(paths * sizeof(glm::vec4), "light of paths"));
    PFVOX_TRY(gpu::Buffer, hits, create(paths * sizeof(shared::PathHit), "hits of paths"));
    PFVOX_TRY(gpu::Buffer, rays0, create(paths * sizeof(std::uint32_t), "waiting rays"));
    PFVOX_TRY(gpu::Buffer, rays1, create(paths * sizeof(std::uint32_t), "waiting rays"));
    PFVOX_TRY(gpu::Buffer, sunRays, create(paths * sizeof(shared::ShadowRay), "rays to the sun"));
    PFVOX_TRY(gpu::Buffer, emitterRays, create(paths * sizeof(shared::ShadowRay), "rays to emitters"));
    PFVOX_TRY(gpu::Buffer, control, create(sizeof(shared::WaveControl), "bake control"));
    PFVOX_CHECK(device.upload(control, 0, gpu::bytesOf(shared::WaveControl{})));
    return Buffers{std::move(itemList), std::move(runs),        std::move(states),
                   std::move(arrived),  std::move(hits),        {std::move(rays0), std::move(rays1)},
                   std::move(sunRays),  std::move(emitterRays), std::move(control)};
}

/// An eighth of the device's memory at most.
std::uint64_t PathWaves::itemsFor(const gpu::DeviceInfo& device) {
    if (device.kind == gpu::DeviceKind::Software) return kLeastItems;
    return std::clamp(device.localMemoryBytes / 8 / (kBytesPerPath * shared::kItemPaths), kLeastItems,
                      kMostItems);
}

Result<PathWaves> PathWaves::create(gpu::Device& device, const WaveOptions& options, std::uint64_t items) {
    PFVOX_TRY(Programs, programs, createPrograms(device, options));
    PFVOX_TRY(Buffers, buffers, createBuffers(device, items));
    return PathWaves(device, options, std::move(programs), std::move(buffers), items);
}

void PathWaves::describe(shared::BakeWave& wave) const {
    wave.items = buffers_.items.addressWords();
    wave.runs = buffers_.runs.addressWords();
    wave.paths = buffers_.paths.addressWords();
    wave.arrived = buffers_.arrived.addressWords();
    wave.hits = buffers_.hits.addressWords();
    wave.rays[0] = buffers_.rays[0].addressWords();
    wave.rays[1] = buffers_.rays[1].addressWords();
    wave.shadowRays[0] = buffers_.sunRays.addressWords();
    wave.shadowRays[1] = buffers_.emitterRays.addressWords();
    wave.control = buffers_.control.addressWords();
}

Result<void> PathWaves::trace(std::span<const TileWork> work, glm::uvec2 wave, const WorkDone& done) {
    std::vector<glm::uvec2> items;
    std::vector<shared::GatherRun> runs;
    const auto traceThese = [&]() -> Result<void> {
        const auto started = std::chrono::steady_clock::now();
        PFVOX_TRY(const BakePass, pass, traceWave(items, runs, wave));
        pace_.took(items.size(), secondsSince(started), options_.submitSeconds);
        items.clear();
        runs.clear();
        return done(pass);
    };
    for (const TileWork& tile : work) {
        for (std::uint32_t batch = 0; batch < tile.batches;) {
            const std::size_t room = pace_.size() - items.size();
            const auto count = static_cast<std::uint32_t>(std::min<std::size_t>(room, tile.batches - batch));
            runs.push_back({.firstItem = static_cast<std::uint32_t>(items.size()),
                            .itemCount = count,
                            .tile = tile.tile,
                            .reserved = 0});
            for (std::uint32_t i = 0; i < count; ++i)
                items.push_back({tile.tile, tile.firstBatch + batch + i});
            batch += count;
            if (items.size() >= pace_.size()) PFVOX_CHECK(traceThese());
        }
    }
    if (items.empty()) return {};
    return traceThese();
}

std::uint32_t PathWaves::recordSteps(Recording& recording, std::uint32_t steps, std::uint32_t set) const {
    for (std::uint32_t i = 0; i < steps; ++i) {
        recording.queued(programs_.castRays, shared::kQueueRays, set);
        recording.queued(programs_.scatter, shared::kQueueRays, set);
        set = 1 - set;
        recording.groups(programs_.queue, 1, 1, set);
        if (options_.hasSun) recording.queued(programs_.castSun, shared::kQueueSun, set);
        if (options_.hasEmitters) recording.queued(programs_.castEmitters, shared::kQueueEmitters, set);
    }
    return set;
}

Result<BakePass> PathWaves::traceWave(std::span<const glm::uvec2> items,
                                      std::span<const shared::GatherRun> runs, glm::uvec2 wave) {
    PFVOX_CHECK(device_->upload(buffers_.items, 0, std::as_bytes(items)));
    PFVOX_CHECK(device_->upload(buffers_.runs, 0, std::as_bytes(runs)));
    const auto itemCount = static_cast<std::uint32_t>(items.size());
    const auto runCount = static_cast<std::uint32_t>(runs.size());
    Recording recording(wave, buffers_.control);
    std::uint32_t set = emptySet_;
    recording.groups(programs_.begin, itemCount, itemCount * (shared::kItemPaths / shared::kBakeGroupSize),
                     set);
    recording.groups(programs_.queue, 1, 1, set);
    if (options_.hasEmitters) recording.queued(programs_.castEmitters, shared::kQueueEmitters, set);

    // All at once where the number of vertices is known.
    const bool known = !options_.hasGlass && options_.maxBounces < 2 * kStepsPerSubmit;
    set = recordSteps(recording, known ? options_.maxBounces + 1 : kStepsPerSubmit, set);
    if (known) recording.groups(programs_.gather, runCount, runCount);
    BakePass pass;
    PFVOX_TRY(const double, firstMs, recording.run(*device_));
    pass.gpuMs = firstMs;
    PFVOX_TRY(shared::WaveControl, control, readControl());
    while (!known && control.waiting[shared::kQueueKinds * set + shared::kQueueRays] != 0) {
        set = recordSteps(recording, kStepsPerSubmit, set);
        PFVOX_TRY(const double, moreMs, recording.run(*device_));
        pass.gpuMs += moreMs;
        PFVOX_TRY(const shared::WaveControl, now, readControl());
        control = now;
    }
    emptySet_ = 1 - set;
    if (!known) {
        recording.groups(programs_.gather, runCount, runCount);
        PFVOX_TRY(const double, gatherMs, recording.run(*device_));
        pass.gpuMs += gatherMs;
    }
    const std::uint64_t rays = control.raysLow | std::uint64_t{control.raysHigh} << 32;
    pass.rays = rays - rays_;
    rays_ = rays;
    return pass;
}

Result<shared::WaveControl> PathWaves::readControl() {
    shared::WaveControl control{};
    PFVOX_CHECK(device_->download(buffers_.control, 0, std::as_writable_bytes(std::span(&control, 1))));
    return control;
}

Result<std::uint64_t> PathWaves::stepLimitRays() {
    PFVOX_TRY(const shared::WaveControl, control, readControl());
    return control.stepLimitRays;
}

}  // namespace pfvox::bake
