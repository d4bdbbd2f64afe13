// Which grids of a VDB become models, and which one colors them.
#pragma once

#include <cstdint>
#include <pfvox/error.hpp>
#include <string_view>
#include <vector>

#include "import/vdb/vdb_header.hpp"

namespace pfvox::import::vdb {

enum class GridKind : std::uint8_t {
    Scalar,    ///< float, double: fog volume or level set
    Topology,  ///< bool, mask
    Integer,   ///< int32, int64: material ids
    Vector,    ///< vec3s, vec3d: colors if the name says so
    Points,
    Other,
};

GridKind kindOf(const GridDescriptor& grid);

struct GridSelection {
    std::vector<std::size_t> models;  ///< indices of descriptors
    std::vector<std::size_t> color;  ///< gives colors: one vector grid, or float grids of red, green and blue
};

/// Chooses by name, or everything that can be a model when `names` is empty; of an export of pfvox the grids
/// of materials only, because the others say the same to other programs. Unusable grids are reported; they
/// are an error when they were asked for or when nothing else is left. Errors: BadReference (no grid of a
/// name; the message lists all), UnsupportedFeature, NothingToConvert.
Result<GridSelection> selectGrids(const std::vector<GridDescriptor>& grids,
                                  const std::vector<std::string>& names, Diagnostics& diagnostics);

}  // namespace pfvox::import::vdb
