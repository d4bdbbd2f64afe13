// The device's part of a bake of faces: rays that link faces, their light by sweeps through the links, and a
// final gather whose values go into the file (shared/faces.glsl.h has the programs).
#pragma once

#include <pfvox/bake.hpp>
#include <pfvox/gpu_faces.hpp>
#include <vector>

#include "bake/bake_scene.hpp"
#include "bake/path_waves.hpp"
#include "shared/faces.glsl.h"

namespace pfvox::bake {

/// What a bake of all faces of a scene gives.
struct TracedFaces {
    FaceValues light;
    std::vector<std::uint64_t> firstValue;  ///< a face, and the end
    std::vector<float> noise;               ///< a face: relative standard error of its neighborhood
    std::uint64_t dividedFaces = 0;
    std::uint64_t noisyValues = 0;  ///< stopped at the largest number of rays
    std::uint32_t sweeps = 0;
    double meanNoise = 0.0;
    BakePass sun;
    BakePass links;
    BakePass solve;
    BakePass gather;
};

class FaceTracer {
  public:
    /// `scene` was built with faces and outlives the tracer. Errors: GpuOutOfMemory, GpuLost.
    static Result<FaceTracer> create(gpu::Device& device, const gpu::Scene& scene, const Sun& sun,
                                     const Sky& sky, const EmitterList& emitters,
                                     const BakeSettings& settings);

    Result<TracedFaces> run(const WorkDone& done);
    /// Rays that the traversal gave up.
    Result<std::uint64_t> stepLimitRays();

  private:
    struct Programs {
        gpu::Program sun;
        gpu::Program links;
        gpu::Program gather;
        gpu::Program sweep;
        gpu::Program noise;
        gpu::Program divide;
    };
    /// What a list of values needs.
    struct Values {
        gpu::Buffer sums;
        gpu::Buffer quarters;
        gpu::Buffer goals;
        gpu::Buffer clusters;
        gpu::Buffer noise;
        std::optional<gpu::Buffer> parts;
        std::uint32_t count = 0;
        std::uint32_t clusterCount = 0;
    };
    struct Buffers {
        gpu::Buffer bake;
        gpu::Buffer control;
        gpu::Buffer frames;
        gpu::Buffer faces;
        gpu::Buffer sun;
        gpu::Buffer direct;
        gpu::Buffer light[2];
        gpu::Buffer links;
        gpu::Buffer levels;
    };
    FaceTracer(gpu::Device& device, const gpu::Scene& scene, BakeSceneBuffers bakeScene, Programs programs,
               Buffers buffers, const BakeSettings& settings)
        : device_(&device),
          scene_(&scene),
          bakeScene_(std::move(bakeScene)),
          programs_(std::move(programs)),
          buffers_(std::move(buffers)),
          settings_(settings) {}
    static Result<Programs> createPrograms(gpu::Device& device, const gpu::Scene& scene);
    static Result<Buffers> createBuffers(gpu::Device& device, const gpu::Scene& scene, std::uint32_t links);

    Result<Values> createValues(std::span<const std::uint32_t> clusters, std::span<const glm::uvec2> parts);
    Result<void> describe(const Values& values);
    /// Launches a program over values, faces or clusters in pieces; `unit` rays each, 0 = none.
    struct Launch {
        const gpu::Program* program;
        std::uint32_t count;
        std::uint32_t perGroup;
        std::uint32_t firstBatch = 0;
        std::uint32_t batchEnd = 0;
        std::uint32_t source = 0;
    };
    Result<void> launch(const Launch& work, BakePass& sum, const WorkDone& done);
    Result<shared::FaceControl> readControl();
    Result<void> writeControl(const shared::FaceControl& control);

    Result<void> solve(const Values& values, TracedFaces& result, const WorkDone& done);
    /// What counts as dark, from the light so far.
    Result<void> findFloor(const Values& values);
    Result<void> gather(const Values& values, TracedFaces& result, const WorkDone& done);
    Result<std::vector<std::uint32_t>> divide(const Values& values, TracedFaces& result,
                                              const WorkDone& done);
    Result<TracedFaces> assemble(const Values& whole, const std::optional<Values>& divided,
                                 std::span<const std::uint32_t> levels, TracedFaces result);

    gpu::Device* device_;
    const gpu::Scene* scene_;
    BakeSceneBuffers bakeScene_;
    Programs programs_;
    Buffers buffers_;
    BakeSettings settings_;
    std::uint32_t linkCount_ = 0;
    std::uint32_t source_ = 0;  ///< which light the faces have
    float noiseFloor_ = 0.0f;
    std::uint64_t raysBefore_ = 0;
    Pace pace_{1, 1};  ///< batches of rays
};

}  // namespace pfvox::bake
