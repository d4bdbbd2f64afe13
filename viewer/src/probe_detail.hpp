// ProbeDetail: what a window tells about one probe: figures, and its maps as small images.
#pragma once

#include <filesystem>
#include <optional>
#include <pfvox/probe_file.hpp>
#include <vector>

namespace pfvox::viewer {

/// 8-bit sRGB with alpha, as Picture has it; rows from the top.
struct SmallMap {
    std::uint32_t resolution = 0;
    std::vector<std::uint32_t> pixels;
    bool operator==(const SmallMap&) const = default;
};

struct ProbeDetail {
    std::uint32_t index = 0;
    glm::vec3 position{0.0f};  ///< metres, offset counted
    ProbeRecord record;
    glm::vec3 meanLight{0.0f};  ///< I; of the light map, else of the irradiance map
    glm::vec3 maxLight{0.0f};   ///< by channel
    std::optional<float>
        minDepthMetres;  ///< to the nearest surface; nothing when it sees none, or has no depth map
    std::optional<float> surfaceFraction;  ///< of the directions that see a surface
    SmallMap light, normals, depth;        ///< resolution 0 where there is no such map
};

inline constexpr std::uint32_t kSmallMapResolution = 32;  ///< at most: every so-manieth texel of a larger map

/// Reads one probe of a file. Errors: those of ProbeFileReader::open and readProbe; BadReference (no such
/// probe).
Result<ProbeDetail> readProbeDetail(const std::filesystem::path& file, std::uint32_t probe,
                                    Diagnostics& diagnostics);

}  // namespace pfvox::viewer
