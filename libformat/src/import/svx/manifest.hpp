// Manifest: manifest.xml of an SVX file, the description of its grid and channels.
// Source: SVX format specification, https://abfab3d.com/svx-format/ (docs/import.md has what real files do
// beyond it).
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <optional>
#include <pfvox/error.hpp>
#include <pfvox/limits.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "import/svx/slice_pattern.hpp"

namespace pfvox::import::svx {

enum class ChannelKind : std::uint8_t {
    Density,       ///< DENSITY: 0 empty to max full
    Color,         ///< COLOR-RGB and its other spellings
    DensityColor,  ///< DENSITY_COLOR of AbFab3D: color with the density as alpha
    Red,           ///< RED, GREEN and BLUE of AbFab3D: a color in three channels
    Green,
    Blue,
    Material,  ///< MATERIAL: fraction of material `id`
    Custom,    ///< CUSTOM: meaning unknown
    Other,     ///< anything else
};

struct Channel {
    std::string type;  ///< as written
    ChannelKind kind = ChannelKind::Other;
    std::int64_t id = 0;
    std::optional<std::uint32_t> bits;
    SlicePattern slices;
};

struct Manifest {
    glm::ivec3 gridSize{0};
    glm::dvec3 originMetres{0.0};  ///< lower corner of the grid
    std::optional<double> voxelSizeMetres;
    std::uint32_t subvoxelBits = 8;
    int sliceAxis = 1;  ///< 0, 1, 2 = X, Y, Z
    std::vector<Channel> channels;
    std::map<std::int64_t, std::string> materialUrns;  ///< by material id
    std::vector<std::string> metadata;                 ///< "key: value"
};

/// Errors, with line and column: BadStructure (no XML, no grid), BadValue, LimitExceeded (maxModelDepth).
Result<Manifest> parseManifest(std::string_view xml, const Limits& limits, Diagnostics& diagnostics);

}  // namespace pfvox::import::svx
