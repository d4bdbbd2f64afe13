// The device's part of a bake: what one probe sees, and the light there.
#pragma once

#include <functional>
#include <pfvox/bake.hpp>
#include <pfvox/gpu_scene.hpp>
#include <vector>

#include "bake/emitters.hpp"
#include "bake/tile_sums.hpp"

namespace pfvox::bake {

/// Edges of the maps that are traced: those that are stored, or enough for the small layers where none are.
struct TracedEdges {
    std::uint32_t depth = 0;
    std::uint32_t light = 0;
};
TracedEdges tracedEdges(const ProbeResolution& resolution);

struct TracerInput {
    const Sun& sun;
    const Sky& sky;
    const EmitterList& emitters;
    bool hasGlass = false;
    DepthEncoding depth;
};

/// After each piece of work: an error ends the bake.
using WorkDone = std::function<Result<void>(const BakePass& pass)>;

class ProbeTracer {
  public:
    /// The scene must outlive the tracer.
    static Result<ProbeTracer> create(gpu::Device& device, const gpu::Scene& scene, const TracerInput& input,
                                      const BakeSettings& settings);

    /// Texels of the traced depth map, row by row. They stay on the device for light().
    Result<std::vector<shared::SeenTexel>> see(const glm::vec3& position, const WorkDone& done);
    /// Indirect light at what the last see() saw. `probe`: index in the grid.
    Result<TileSums> light(std::uint32_t probe, const glm::vec3& position,
                           std::span<const shared::SeenTexel> seen, const WorkDone& done);

    TracedEdges edges() const { return edges_; }
    /// Rays that the traversal gave up since the tracer was made.
    Result<std::uint64_t> cappedRays();

  private:
    struct Buffers {
        gpu::Buffer scene;     ///< shared::BakeScene
        gpu::Buffer emitters;
        gpu::Buffer texels;    ///< shared::SeenTexel
        gpu::Buffer items;
        gpu::Buffer sums;
        gpu::Buffer counters;
    };
    ProbeTracer(gpu::Device& device, gpu::Program geometry, gpu::Program light, Buffers buffers)
        : device_(&device), geometry_(std::move(geometry)), light_(std::move(light)), buffers_(std::move(buffers)) {}
    static Result<Buffers> createBuffers(gpu::Device& device, const TracerInput& input, const TracedEdges& edges);
    /// Sums of kBatchSamples paths for each texel of each item; the milliseconds that the device took.
    Result<double> runBatches(std::span<const LightItem> items, const shared::LightPush& push,
                              std::vector<glm::vec4>& sums, std::uint64_t& rays);
    Result<void> runItems(std::span<const LightItem> items, const shared::LightPush& push, TileSums& sums,
                          const WorkDone& done);

    /// How much work fits into one dispatch, learnt from those before.
    class Pace {
      public:
        explicit Pace(std::size_t most) : most_(most) {}
        std::size_t size() const { return size_; }
        void took(std::size_t size, double seconds, double target);

      private:
        std::size_t size_ = 32;
        std::size_t most_;
    };

    gpu::Device* device_;
    gpu::Program geometry_;
    gpu::Program light_;
    Buffers buffers_;
    TracedEdges edges_;
    std::uint32_t samplesPerRun_ = shared::kBatchSamples;
    DepthEncoding depth_;
    TileRules rules_;
    double dispatchSeconds_ = 0.25;
    Pace geometryPace_{std::size_t{1} << 15};  ///< in workgroups
    Pace lightPace_{4096};
};

}  // namespace pfvox::bake
