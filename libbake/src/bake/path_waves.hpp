// Paths by the million, one vertex of all of them at a time (Laine, Karras and Aila 2013, "Megakernels
// Considered Harmful"): small programs and full subgroups, where one program of whole paths has neither.
//
//     items of work -> begin -> { cast -> scatter -> queue -> cast shadow rays } until none is left -> gather
//     -> sums
#pragma once

#include <algorithm>
#include <functional>
#include <pfvox/bake.hpp>
#include <pfvox/gpu_scene.hpp>
#include <span>
#include <vector>

#include "shared/bake.glsl.h"

namespace pfvox::bake {

/// After each piece of work: an error ends the bake.
using WorkDone = std::function<Result<void>(const BakePass& pass)>;

/// Batches of one tile of the group: shared::kItemPaths paths each.
struct TileWork {
    std::uint32_t tile = 0;
    std::uint32_t firstBatch = 0;
    std::uint32_t batches = 0;
};

/// How much work fits into one submission, learnt from those before.
class Pace {
  public:
    Pace(std::size_t first, std::size_t most) : size_(std::min(first, most)), most_(most) {}
    std::size_t size() const { return size_; }
    void took(std::size_t size, double seconds, double target);

  private:
    std::size_t size_;
    std::size_t most_;
};

struct WaveOptions {
    bool hasGlass = false;
    bool hasSun = false;
    bool hasEmitters = false;
    bool stratified = true;
    std::uint32_t maxBounces = shared::kMaxPathBounces;
    double submitSeconds = 0.25;
};

class PathWaves {
  public:
    /// `items`: kItemPaths paths each, traced at a time.
    static Result<PathWaves> create(gpu::Device& device, const WaveOptions& options, std::uint64_t items);
    static constexpr std::uint64_t kLeastItems = 64;
    /// As many as do this device good.
    static std::uint64_t itemsFor(const gpu::DeviceInfo& device);

    /// Where the paths lie; all but these members of `wave` are the caller's.
    void describe(shared::BakeWave& wave) const;
    /// Traces the work in waves and adds it to the sums. `wave`: address of the shared::BakeWave.
    Result<void> trace(std::span<const TileWork> work, glm::uvec2 wave, const WorkDone& done);

    /// Paths that are traced at a time, at most.
    std::uint64_t mostPaths() const { return mostItems_ * shared::kItemPaths; }
    /// Rays that the traversal gave up since this was made.
    Result<std::uint64_t> stepLimitRays();
    static std::uint64_t bytesFor(std::uint64_t paths);

  private:
    struct Programs {
        gpu::Program begin;
        gpu::Program castRays;
        gpu::Program scatter;
        gpu::Program queue;
        gpu::Program castSun;
        gpu::Program castEmitters;
        gpu::Program gather;
    };
    struct Buffers {
        gpu::Buffer items;
        gpu::Buffer runs;
        gpu::Buffer paths;
        gpu::Buffer arrived;
        gpu::Buffer hits;
        gpu::Buffer rays[2];
        gpu::Buffer sunRays;
        gpu::Buffer emitterRays;
        gpu::Buffer control;
    };
    PathWaves(gpu::Device& device, const WaveOptions& options, Programs programs, Buffers buffers,
              std::size_t items);
    static Result<Programs> createPrograms(gpu::Device& device, const WaveOptions& options);
    static Result<Buffers> createBuffers(gpu::Device& device, std::uint64_t items);

    Result<BakePass> traceWave(std::span<const glm::uvec2> items, std::span<const shared::GatherRun> runs,
                               glm::uvec2 wave);
    class Recording;
    Result<shared::WaveControl> readControl();
    /// Vertices of all paths whose rays wait in `set`; the set that they wait in afterwards.
    std::uint32_t recordSteps(Recording& recording, std::uint32_t steps, std::uint32_t set) const;

    gpu::Device* device_;
    WaveOptions options_;
    Programs programs_;
    Buffers buffers_;
    std::size_t mostItems_;
    Pace pace_;
    std::uint32_t emptySet_ = 0;  ///< of the queues: a wave begins there
    std::uint64_t rays_ = 0;
};

}  // namespace pfvox::bake
