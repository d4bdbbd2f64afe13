// RayQuery: batches of rays through a scene on the device; for tests, benchmarks and picking.
//
// It runs shaders/octree_trace.glsl, the traversal of every other program.
#pragma once

#include <limits>
#include <pfvox/gpu.hpp>
#include <pfvox/gpu_scene.hpp>
#include <span>
#include <vector>

namespace pfvox::gpu {

/// Any non-zero direction; distances count in its lengths.
struct GpuRay {
    glm::dvec3 origin{0.0};                          ///< in the world, metres
    glm::vec3 direction{0.0f, 0.0f, -1.0f};          ///< any length but 0
    float tMax = std::numeric_limits<float>::max();  ///< in lengths of the direction
    float cone = 0.0f;  ///< width in parts of the distance: finer levels of detail are not told apart
};
/// The first surface on a ray.
struct GpuHit {
    bool hit = false;  ///< false: the rest means nothing
    float t = 0.0f;    ///< in lengths of the direction
    std::uint32_t instance =
        0;                   ///< in the order of the scene's parts and their instances, hidden ones counted
    glm::ivec3 voxel{0};     ///< in the model
    glm::vec3 normal{0.0f};  ///< in the world, unit length, towards the ray
    std::uint32_t material = 0;     ///< in the materials of all parts, one after the other
    std::uint8_t face = 0;          ///< of the voxel: 0..5 = -x +x -y +y -z +z, 6 = the ray starts inside it
    std::uint32_t steps = 0;        ///< iterations of the octree loop
    bool stepLimitReached = false;  ///< given up in some instance after too many steps; never in valid data
    std::uint32_t lodColor =
        0;                      ///< of a level of detail: R, G, B (sRGB), coverage, R in the low byte; else 0
    std::int32_t cellLog2 = 0;  ///< edge of the cell that was hit = 2^cellLog2 voxels
};
/// What is asked of a ray.
enum class RayMode : std::uint8_t {
    ClosestHit,
    AnyHit,  ///< only `hit`, `steps` and `stepLimitReached` are set
};
/// What cast() gives.
struct RayBatch {
    std::vector<GpuHit> hits;  ///< hits[i] belongs to rays[i]
    double gpuMs = 0.0;  ///< of the launch, transfers not counted; 0 where the device has no time stamps
};
/// Casts rays against a scene: for tests and measurements. Not thread-safe.
class RayQuery {
  public:
    /// Errors: those of Device::createProgram.
    static Result<RayQuery> create(Device& device);

    /// Casts all rays and waits. Errors: GpuOutOfMemory, GpuLost.
    Result<RayBatch> cast(Device& device, const Scene& scene, std::span<const GpuRay> rays,
                          RayMode mode) const;

  private:
    explicit RayQuery(Program program) : program_(std::move(program)) {}
    Program program_;
};

}  // namespace pfvox::gpu
