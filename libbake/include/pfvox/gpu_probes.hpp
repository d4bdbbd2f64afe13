// GpuProbes: a probe field in device memory, ready for lookups and light-field tracing.
//
//     ProbeFileReader -> [GpuProbes::upload] -> device buffers -> shaders/probe_lookup.glsl,
//     shaders/probe_trace.glsl
//
// The layout is that of shaders/shared/probes.glsl.h. Probes are read one by one, straight into staging
// memory: nothing but the device ever holds the field as a whole. World units are metres.
#pragma once

#include <pfvox/gpu.hpp>
#include <pfvox/probe_file.hpp>
#include <span>
#include <vector>

namespace pfvox::gpu {

/// Which step of the lookup gave most of a value.
enum class ProbeTier : std::uint8_t { None, Texels, Traced, Compact, Nearest, Faces };
inline constexpr std::size_t kProbeTierCount = 6;  ///< tiers of ProbeTier, None included
/// "none", "texels", "traced", "compact", "nearest", "faces".
std::string_view toString(ProbeTier tier);

/// What of a probe file goes to the device.
struct GpuProbeSettings {
    float voxelMetres = 0.1f;  ///< edge of a voxel of the scene: what offsets are measured in
    glm::dvec3 origin{0.0};    ///< of the device's frame, in the world: gpu::Scene::origin()
    bool compactOnly = false;  ///< leave depth and light maps out: for pictures of the compact layers alone
};
/// What the probes take there.
struct GpuProbeStatistics {
    std::uint32_t probes = 0;
    std::uint32_t active = 0;  ///< of them, with maps
    std::uint64_t mapBytes = 0;
    std::uint64_t tableBytes = 0;  ///< entries and proximity grid
    std::uint64_t totalBytes() const { return mapBytes + tableBytes; }
};

/// Immutable once made. Keeps its device alive; does not keep the reader.
class GpuProbes {
  public:
    /// What an upload will take of device memory, bytes.
    static std::uint64_t bytesOf(const ProbeFileReader& reader, const GpuProbeSettings& settings);

    /// Errors: BadStructure (a shard: merge it first), those of ProbeFileReader::readLayer, GpuOutOfMemory
    /// (the message says how much is needed), GpuLost.
    static Result<GpuProbes> upload(Device& device, const ProbeFileReader& reader,
                                    const GpuProbeSettings& settings);

    /// Device address of the shared::ProbeFieldRecord.
    glm::uvec2 address() const { return table_.addressWords(); }
    const GpuProbeStatistics& statistics() const { return statistics_; }

  private:
    GpuProbes(Buffer table, std::vector<Buffer> blocks)
        : table_(std::move(table)), blocks_(std::move(blocks)) {}

    Buffer table_;                ///< record, entries, proximity grid
    std::vector<Buffer> blocks_;  ///< maps
    GpuProbeStatistics statistics_;
};

}  // namespace pfvox::gpu
