// The device's part of a bake: what a group of probes sees, and the light there.
#pragma once

#include <optional>
#include <pfvox/gpu_faces.hpp>
#include <pfvox/gpu_scene.hpp>

#include "bake/bake_scene.hpp"
#include "bake/path_waves.hpp"
#include "bake/tile_rounds.hpp"

namespace pfvox::bake {

/// Edges of the maps that are traced: those that are stored, or enough for the small layers where none are.
struct TracedResolution {
    std::uint32_t depth = 0;
    std::uint32_t light = 0;
};
TracedResolution tracedResolution(const ProbeResolution& resolution);

struct TracerInput {
    const Sun& sun;
    const Sky& sky;
    const EmitterList& emitters;
    bool hasGlass = false;
    DepthEncoding depth;
    const gpu::GpuFaces* faces = nullptr;  ///< light is taken from them, not traced; outlives the tracer
};

/// What was traced for one probe: texels row by row, `resolution.depth` and `resolution.light` along a row.
struct TracedProbe {
    TracedResolution resolution;
    std::vector<std::uint32_t> words;  ///< of ProbeLayer::DepthNormal
    std::vector<float> metres;         ///< along the texel's direction, < 0 = nothing
    std::vector<glm::vec3> light;      ///< I; 0 where no surface is seen
    std::vector<float> errors;         ///< standard error of the mean channel of that
    std::vector<glm::vec3> leaving;    ///< radiance towards the probe of Lambert surfaces, or the sky's
    TileSummary tiles;
};

class ProbeTracer {
  public:
    /// The scene must outlive the tracer. Errors: GpuOutOfMemory (what is needed, and what to change).
    static Result<ProbeTracer> create(gpu::Device& device, const gpu::Scene& scene, const TracerInput& input,
                                      const BakeSettings& settings);

    /// Probes that fit into one group.
    std::uint32_t groupSize() const { return groupSize_; }

    /// The group's maps: see(), then light(), then collect() for each of its probes. At most groupSize()
    /// probes.
    Result<void> see(std::span<const shared::BakeProbe> probes, const WorkDone& done);
    Result<void> light(const WorkDone& done);
    Result<TracedProbe> collect(std::uint32_t probe);
    /// Of a probe of the group, as the device has them.
    Result<std::vector<shared::SeenTexel>> seenTexels(std::uint32_t probe);

    /// Rays of paths that the traversal gave up since the tracer was made.
    Result<std::uint64_t> stepLimitRays();

  private:
    struct Programs {
        gpu::Program geometry;
        gpu::Program resetTiles;
        gpu::Program tiles;
        gpu::Program finish;
        gpu::Program faces;
    };
    struct Buffers {
        gpu::Buffer wave;  ///< shared::BakeWave
        gpu::Buffer probes;
        gpu::Buffer texels;  ///< shared::SeenTexel
        gpu::Buffer sums;
        gpu::Buffer tiles;
        gpu::Buffer maps;
    };
    ProbeTracer(gpu::Device& device, PathWaves waves, BakeSceneBuffers scene, Programs programs,
                Buffers buffers)
        : device_(&device),
          waves_(std::move(waves)),
          scene_(std::move(scene)),
          programs_(std::move(programs)),
          buffers_(std::move(buffers)) {}
    static Result<ProbeTracer> createFor(gpu::Device& device, const gpu::Scene& scene,
                                         const TracerInput& input, const BakeSettings& settings,
                                         std::uint64_t items);
    static Result<Programs> createPrograms(gpu::Device& device, bool hasGlass);
    static Result<Buffers> createBuffers(gpu::Device& device, const TracedResolution& resolution,
                                         std::uint32_t probes);
    Result<double> run(const gpu::Program& program, std::uint32_t first, std::uint32_t count,
                       std::uint32_t perGroup);
    std::uint32_t tilesPerProbe() const {
        return resolution_.light * resolution_.light / shared::kTileTexels;
    }
    /// Noise of all tiles of the group, after `program` has judged them.
    Result<std::vector<shared::TileStatistics>> judgeTiles(const gpu::Program& program);

    gpu::Device* device_;
    PathWaves waves_;
    BakeSceneBuffers scene_;
    Programs programs_;
    Buffers buffers_;
    TracedResolution resolution_;
    TileRules rules_;
    const gpu::GpuFaces* faces_ = nullptr;
    double submitSeconds_ = 0.25;
    std::uint32_t groupSize_ = 1;
    std::uint32_t probeCount_ = 0;  ///< of the group
    bool finished_ = false;         ///< its maps are there
    std::vector<shared::TileStatistics> judged_;
    Pace geometryPace_{std::size_t{1} << 11, std::size_t{1} << 18};  ///< in workgroups
};

}  // namespace pfvox::bake
