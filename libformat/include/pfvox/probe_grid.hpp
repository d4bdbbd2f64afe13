// ProbeGrid: where the probes of a field stand.
//
//     scene.toml -> [fitProbeGrid] -> ProbeGrid -> baker -> PF_PROBE file
//
// Metres. Plain data.
#pragma once

#include <cstdint>
#include <pfvox/math.hpp>

namespace pfvox {

/// Where the probes stand. Any counts; probe (x, y, z) has the index x + counts.x * (y + counts.y * z).
struct ProbeGrid {
    glm::vec3 start{0.0f};   ///< position of probe (0, 0, 0), metres
    glm::vec3 step{1.0f};    ///< distance of neighbors along each axis, metres, > 0
    glm::uvec3 counts{1u};   ///< each at least 1, the product below 2^32; all 0 = no probes
    glm::dvec3 origin{0.0};  ///< in the world, metres: what all else of a field counts from (frameOrigin)

    std::uint64_t probeCount() const { return std::uint64_t{counts.x} * counts.y * counts.z; }
    std::uint32_t indexOf(glm::uvec3 at) const { return at.x + counts.x * (at.y + counts.y * at.z); }
    glm::uvec3 placeOf(std::uint32_t index) const {
        return {index % counts.x, index / counts.x % counts.y, index / counts.x / counts.y};
    }
    /// The grid point of a probe; the probe itself stands at this plus ProbeRecord::offset.
    glm::vec3 pointOf(std::uint32_t index) const { return start + step * glm::vec3{placeOf(index)}; }
    /// In the world, of what lies there in the field.
    glm::dvec3 worldOf(const glm::vec3& point) const { return origin + glm::dvec3(point); }
    /// The distance at which the moments end, 1.5 diagonals of a cell, metres. It is their unit.
    float momentRange() const { return 1.5f * glm::length(step); }
    bool operator==(const ProbeGrid&) const = default;
};

}  // namespace pfvox
