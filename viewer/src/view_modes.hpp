// View modes: what the colors of a picture show, in one table that command line, keys, panels, help and tests
// share.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace pfvox::viewer {

enum class ViewMode : std::uint8_t {
    Final,            ///< sun with shadow, indirect light, sky, emission, reflections, glass
    Albedo,           ///< base color
    Normals,          ///< world normal, [-1, 1] to [0, 1]
    Material,         ///< a color for each material index
    Depth,            ///< edge of the leaf in the octree: hot = one voxel, cold = 64 and more
    Steps,            ///< iterations of the traversal: cold = few
    Lod,              ///< edge of the cell that was hit: hot = one voxel; dark where it is no level of detail
    Indirect,         ///< I = E / pi of indirect light alone, without what the material makes of it
    Tiers,            ///< which step of the lookup gave that value; magenta = none
    Field,            ///< camera rays traced through the probes: hit, miss, unknown
    FieldDifference,  ///< how that differs from tracing the octree
    AtlasLight,       ///< maps of probes: indirect light where each texel looks
    AtlasNormals,     ///< maps of probes: normals
    AtlasDepth,       ///< maps of probes: distance codes, near = bright
};

/// What a view shows of: without it there is nothing to see.
enum class ViewNeeds : std::uint8_t { Nothing, Probes, DepthMaps };

struct ViewEntry {
    ViewMode mode;
    std::string_view name;  ///< of --view
    int key;                ///< as KeyBinding has it
    bool control;
    std::string_view keyText;
    std::string_view what;  ///< for help
    ViewNeeds needs;
    bool isRadiance;  ///< exposure and tone map act on it
};

/// In the order of ViewMode.
std::span<const ViewEntry> viewModes();
inline constexpr std::size_t kViewModes = 14;
const ViewEntry& entryOf(ViewMode mode);
std::optional<ViewMode> viewModeFrom(std::string_view name);
std::string_view toString(ViewMode mode);
/// Pages of maps instead of a picture of the scene.
bool isAtlas(ViewMode mode);

/// How radiance becomes a color of the screen.
enum class ToneMap : std::uint8_t {
    Standard,  ///< straight up to 0.7, then a shoulder; colors of the source stay what they are
    Linear,    ///< clamped at 1
    Reinhard,  ///< x / (1 + x) of the luminance
    Aces,      ///< Narkowicz's fit of the ACES curve
    Neutral,   ///< Khronos PBR Neutral
};

struct ToneMapEntry {
    ToneMap toneMap;
    std::string_view name;  ///< of --tonemap and of the settings
    std::string_view what;
};
/// In the order of ToneMap.
std::span<const ToneMapEntry> toneMaps();
std::optional<ToneMap> toneMapFrom(std::string_view name);
std::string_view toString(ToneMap toneMap);

}  // namespace pfvox::viewer
