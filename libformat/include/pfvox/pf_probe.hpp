// PF_PROBE 1.2: a regular grid of light-field probes and the light on faces of voxels, in memory and on disk.
// The bytes are described in docs/format-pf_probe.md.
//
//     baker -> ProbeData, probe by probe -> [ProbeFileWriter] -> file -> [ProbeFileReader] -> viewer
//                                  ProbeField -> [encodePfProbe] -> bytes -> [decodePfProbe] -> ProbeField
//
// This header has the value types and the codec for fields that fit into memory. Large ones are written and
// read probe by probe (pfvox/probe_file.hpp). What a texel means is in pfvox/probe_maths.hpp.
//
// Frame: world space, metres, right-handed, +Y up. A probe's maps are octahedral, +z in their middle; texel
// (i, j) is word i + edge * j and its center is at ((i + 0.5) / edge, (j + 0.5) / edge). What is stored as
// light is I = E / pi of indirect irradiance E at the surface that the texel sees: the light that leaves it
// is emission + albedo * (E_direct / pi + I). Values are plain data: copy them, move them, share them for
// reading.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <pfvox/error.hpp>
#include <pfvox/face_light.hpp>
#include <pfvox/limits.hpp>
#include <pfvox/math.hpp>
#include <pfvox/pf_vox.hpp>
#include <pfvox/probe_grid.hpp>
#include <pfvox/probe_settings.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace pfvox {

inline constexpr std::uint16_t kPfProbeVersionMajor = 1;  ///< another one cannot be read
inline constexpr std::uint16_t kPfProbeVersionMinor = 2;  ///< newest that is written; later ones can be read
inline constexpr std::uint16_t kPfProbePlainMinor = 1;    ///< of files without light on faces

/// The maps that a probe may have. Their words are those that the GPU reads.
enum class ProbeLayer : std::uint8_t {
    DepthNormal,  ///< u32: depth code in bits 0-15 (65535 = miss), normal x and y (snorm8) in 16-23 and 24-31
    Light,        ///< u32: I as R11G11B10F
    MinDepth,     ///< u16: smallest depth code of 16 x 16 texels
    Irradiance,   ///< u32: I of a surface at the probe, by its normal, R11G11B10F, border of 1
    Moments,  ///< u32: two halves, mean of d and of d^2 with d = min(distance / momentRange, 1), border of 1
};
inline constexpr std::size_t kProbeLayerCount = 5;          ///< of ProbeLayer
inline constexpr std::uint32_t kMaxProbeResolution = 8192;  ///< texels along a map

/// "depth-normal", "light", "min-depth", "irradiance", "moments".
std::string_view toString(ProbeLayer layer);

/// Edges of the maps in texels; 0 = the layer is absent.
struct ProbeResolution {
    std::uint32_t depth = 0;  ///< DepthNormal; a multiple of 16. MinDepth has depth / 16, and goes with it
    std::uint32_t light = 0;  ///< Light
    std::uint32_t irradiance = 0;  ///< Irradiance, without its border
    std::uint32_t moments = 0;     ///< Moments, without its border

    /// Texels along the stored map, border included; 0 = absent.
    std::uint32_t edgeOf(ProbeLayer layer) const;
    bool has(ProbeLayer layer) const { return edgeOf(layer) != 0; }  ///< Whether probes have this map.
    /// Raw bytes of one probe's map.
    std::uint64_t bytesOf(ProbeLayer layer) const;
    /// Raw bytes of all maps of one probe.
    std::uint64_t bytesPerProbe() const;
    bool operator==(const ProbeResolution&) const = default;
};
/// The usual sets of maps.
enum class ProbeProfile : std::uint8_t {
    Custom,
    Thesis,   ///< depth 1024, light 1024, irradiance 8, moments 14: for comparison with the original
    Default,  ///< depth 512, light 256, irradiance 8, moments 14
    Compact,  ///< irradiance 8, moments 14
};
/// Precondition: not Custom.
ProbeResolution resolutionOf(ProbeProfile profile);
/// The profile that has this resolution, else Custom.
ProbeProfile profileOf(const ProbeResolution& resolution);
/// "custom", "thesis", "probes", "compact".
std::string_view toString(ProbeProfile profile);

/// How distances become 16-bit codes: round(log(scale * d + 1) / log(scale * far + 1) * 65534).
struct DepthEncoding {
    float scale = 4.0f;        ///< C, 1 / metres, > 0; larger is finer near the probe and coarser far away
    float farMetres = 100.0f;  ///< distances beyond share the last code: choose the diagonal of the scene
    bool operator==(const DepthEncoding&) const = default;
};

/// What the stored light contains: bits of ProbeFieldInfo::lightContent.
inline constexpr std::uint32_t kLightOfSky = 1u << 0;
inline constexpr std::uint32_t kLightOfEmitters = 1u << 1;    ///< emissive voxels
inline constexpr std::uint32_t kLightOfBouncedSun = 1u << 2;  ///< sun from the second vertex of a path on
inline constexpr std::uint32_t kLightOfDirectSun =
    1u << 3;  ///< sun at the first vertex; pfvox leaves it to the viewer
inline constexpr std::uint32_t kLightOfSpecular = 1u << 4;   ///< paths over metal and glass
inline constexpr std::uint32_t kKnownLight = (1u << 5) - 1;  ///< all bits that have a meaning

/// A half-open range of probe indices.
struct ProbeRange {
    std::uint32_t first = 0;  ///< inclusive
    std::uint32_t end = 0;    ///< exclusive

    std::uint32_t size() const { return end - first; }  ///< Number of probes.
    bool contains(std::uint32_t probe) const {
        return probe >= first && probe < end;
    }  ///< Whether the probe is in it.
    bool operator==(const ProbeRange&) const = default;
};

/// Everything about a field but its probes.
struct ProbeFieldInfo {
    /// Where probes stand. Counts of 0, all three: there are none, which a file with light on faces may say.
    ProbeGrid grid;
    /// The probes of this file: a shard has a part of the grid's; with light on faces it may be empty.
    ProbeRange range;
    ProbeResolution resolution;      ///< edges of the maps
    DepthEncoding depth;             ///< meaning of the depth codes
    std::uint32_t lightContent = 0;  ///< kLightOf... bits
    ProbeBakeSettings settings;      ///< how the light was computed
    ContentKey sceneHash;    ///< of the scene as it was baked: models, transforms, materials, sun, sky
    ContentKey shaderHash;   ///< of the programs that computed the light
    std::string deviceName;  ///< of the GPU and its driver; equal bits are promised for equal names only
    std::string toolName;    ///< "probe-bake 0.1.0"
    bool operator==(const ProbeFieldInfo&) const = default;

    bool isWhole() const {
        return range == ProbeRange{0, static_cast<std::uint32_t>(grid.probeCount())};
    }  ///< whole
};
/// Where a probe stands.
enum class ProbeState : std::uint8_t {
    Active,     ///< stands on its grid point
    Inactive,   ///< no free place near its grid point: has no layers, and no lookup reads it
    Relocated,  ///< active, ProbeRecord::offset away from its grid point
};
/// "active", "inactive", "relocated".
std::string_view toString(ProbeState state);

/// What is known about one probe without its maps.
struct ProbeRecord {
    glm::vec3 offset{0.0f};                 ///< from the grid point, metres; not 0 only when Relocated
    ProbeState state = ProbeState::Active;  ///< on its grid point, moved, or without a place
    std::uint16_t flags = 0;                ///< none yet: 0
    /// Relative standard error of I, mean over the tiles. Nothing = unknown: no tile has two batches of paths
    /// whose spread could tell, or the probe sees no surface, or is inactive.
    std::optional<float> error;
    float noisyTileFraction =
        0.0f;  ///< fraction of the tiles that stopped at maxSamples, when that is adaptive
    /// xxh3-64 over offset, state, flags, error, share and the hashes of all layers. Writers compute it and
    /// take no notice of what stands here; readers have checked it. Equal hashes = equal probes.
    std::uint64_t hash = 0;
    bool operator==(const ProbeRecord&) const = default;

    bool isActive() const { return state != ProbeState::Inactive; }  ///< Whether it has maps.
};

/// How many probes are in which state.
struct ProbeCounts {
    std::uint64_t active = 0;     ///< have maps; relocated ones included
    std::uint64_t relocated = 0;  ///< of the active ones
    std::uint64_t inactive = 0;   ///< without a place
};
ProbeCounts countProbes(std::span<const ProbeRecord> records);  ///< of these

/// One probe with its maps; a map that the resolution does not have is empty, and so are all of an inactive
/// one.
struct ProbeData {
    ProbeRecord record;    ///< what is stored beside the maps
    ContentKey inputHash;  ///< of everything that decided the content of this probe; zero = unknown
    std::vector<std::uint32_t> depthNormal;  ///< depth^2 words, row by row, see ProbeLayer
    std::vector<std::uint32_t> light;        ///< light^2 words
    std::vector<std::uint16_t> minDepth;     ///< (depth / 16)^2 words
    std::vector<std::uint32_t> irradiance;   ///< (irradiance + 2)^2 words: with the border
    std::vector<std::uint32_t> moments;      ///< (moments + 2)^2 words: with the border
    bool operator==(const ProbeData&) const = default;

    /// The words of a layer as bytes.
    std::span<const std::byte> bytesOf(ProbeLayer layer) const;
    /// Makes a layer `bytes` long (a multiple of its word) and gives its bytes for writing.
    std::span<std::byte> resizeLayer(ProbeLayer layer, std::uint64_t bytes);
};

inline constexpr std::uint32_t kNoProbe = 0xffffffffu;  ///< an index that names no probe
inline constexpr std::size_t kProbesPerCell = 4;        ///< indices in a cell

/// For each cell of a box up to four probes that see what is in it, best first. Cell (x, y, z) has the index
/// x + counts.x * (y + counts.y * z).
struct ProximityGrid {
    glm::vec3 start{0.0f};              ///< lower corner of cell (0, 0, 0), metres
    glm::vec3 step{1.0f};               ///< edges of a cell, metres, > 0
    glm::uvec3 counts{0u};              ///< cells along x, y, z
    std::vector<std::uint32_t> probes;  ///< kProbesPerCell a cell; kNoProbe at the end of a shorter list

    std::uint64_t cellCount() const { return std::uint64_t{counts.x} * counts.y * counts.z; }
    bool operator==(const ProximityGrid&) const = default;
};

/// A field in memory.
struct ProbeField {
    ProbeFieldInfo info;                     ///< all but the probes
    std::vector<ProbeData> probes;           ///< probe info.range.first and those behind it
    std::optional<ProximityGrid> proximity;  ///< none in shards
    std::optional<FaceLight> faces = {};     ///< what was decoded has the values as they are stored
    bool operator==(const ProbeField&) const = default;
};
/// How a file is written.
struct ProbeEncodeSettings {
    int zstdLevel = 1;      ///< 1 to 19; higher ones gain little, as the maps are predicted before
    ContentKey contentKey;  ///< kept in the header, for builds that skip what is up to date
};

/// The smallest Far for which no distance inside the box is beyond it.
DepthEncoding depthEncodingFor(glm::vec3 boxMin, glm::vec3 boxMax);

/// What ProbeRecord::hash of this probe must be.
std::uint64_t hashOf(const ProbeData& probe);

/// Whether a field can be written: domains of all values, sizes of maps, ranges, references of the proximity
/// grid. Errors: BadValue, BadStructure, BadReference.
Result<void> checkProbeInfo(const ProbeFieldInfo& info);
Result<void> checkProbeData(const ProbeFieldInfo& info, std::uint32_t probe,
                            const ProbeData& data);                                      ///< sizes
Result<void> checkProximityGrid(const ProbeFieldInfo& info, const ProximityGrid& grid);  ///< references

/// The bytes of a PF_PROBE file, equal for equal input. Errors: those of the checks above.
Result<std::vector<std::byte>> encodePfProbe(const ProbeField& field, const ProbeEncodeSettings& settings);

/// Reads a whole file. Errors: BadMagic, UnsupportedVersion, UnsupportedFeature, Truncated, BadValue,
/// BadReference, BadStructure, ChecksumMismatch, LimitExceeded; each with section or probe and offset.
Result<ProbeField> decodePfProbe(std::span<const std::byte> bytes, const Limits& limits,
                                 Diagnostics& diagnostics);

/// Every finding, not only the first: reads each probe and layer, and checks min maps and borders against
/// what they follow from. Empty = valid.
std::vector<Finding> validatePfProbe(std::span<const std::byte> bytes, const Limits& limits);

}  // namespace pfvox
