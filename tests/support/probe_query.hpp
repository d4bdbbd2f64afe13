// ProbeQuery: batches of lookups and light-field rays on the device; for tests and inspection.
//
// It runs shaders/probe_lookup.glsl and shaders/probe_trace.glsl, which the viewer and the verifier include.
#pragma once

#include <limits>
#include <pfvox/gpu.hpp>
#include <pfvox/gpu_probes.hpp>
#include <span>
#include <vector>

namespace pfvox::gpu {
/// A surface point to be lit.
struct ProbePoint {
    glm::vec3 position{0.0f};            ///< on a surface, metres
    glm::vec3 normal{0.0f, 1.0f, 0.0f};  ///< unit, on the side that is seen
};

/// The light of a point, and where it came from.
struct ProbeLookup {
    glm::vec3 indirect{0.0f};          ///< I = E / pi, linear RGB
    ProbeTier tier = ProbeTier::None;  ///< which lookup gave the value
    glm::vec3 weights{0.0f};  ///< of texels, compact and nearest; their sum is 1, or 0 where tier is None
};
/// A ray through the light field.
struct FieldRay {
    glm::vec3 origin{0.0f};                          ///< metres
    glm::vec3 direction{0.0f, 0.0f, -1.0f};          ///< unit
    float tMax = std::numeric_limits<float>::max();  ///< metres, if the direction is unit
};
/// What the field says of a ray.
enum class FieldAnswer : std::uint8_t {
    Miss,  ///< certain
    Hit,
    Unknown,  ///< behind what the probes see
    Filled,   ///< unknown, answered by the nearest probe's view
};
/// How the ray is followed through the maps.
enum class FieldTracing : std::uint8_t {
    Full,
    HighOnly,  ///< without the min maps: the same answers, slower
    Filled,
};
/// What the light field knows of a ray.
struct FieldTrace {
    FieldAnswer answer = FieldAnswer::Unknown;  ///< hit, miss or unknown
    float t = 0.0f;                             ///< metres; of Unknown: how far the ray is known to be free
    glm::vec3 normal{0.0f};                     ///< world, unit; of a hit
    glm::vec3 light{0.0f};                      ///< I where it hits
    std::uint32_t probe = kNoProbe;             ///< that gave the answer
    std::uint32_t lowSteps = 0;                 ///< through the coarse depth maps
    std::uint32_t highSteps = 0;                ///< texel by texel
    std::uint32_t probesAsked = 0;              ///< how many were traced
    std::uint32_t stepLimitReached = 0;         ///< walks that were given up; they count as unknown
};
/// Runs lookups and traces over whole arrays: for tests and measurements. Not thread-safe.
class ProbeQuery {
  public:
    /// Errors: those of Device::createProgram.
    static Result<ProbeQuery> create(Device& device);

    /// Errors of both: GpuOutOfMemory, GpuLost. Rays need a field with depth maps.
    Result<std::vector<ProbeLookup>> lookUp(Device& device, const GpuProbes& probes,
                                            std::span<const ProbePoint> points) const;
    Result<std::vector<FieldTrace>> trace(
        Device& device, const GpuProbes& probes, std::span<const FieldRay> rays,
        FieldTracing tracing) const;  ///< One a ray, in order. Errors: as above.

  private:
    explicit ProbeQuery(Program program) : program_(std::move(program)) {}
    Program program_;
};

}  // namespace pfvox::gpu
