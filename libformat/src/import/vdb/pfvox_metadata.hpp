// What pfvox itself notes in the grids of a VDB, so that an export comes back as it was: all of it string
// metadata, which other programs keep or ignore (docs/decisions/008-vdb-export.md).
//
// Free of OpenVDB: the exporter writes these strings, the importer reads them with its own parser.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <pfvox/asset.hpp>
#include <pfvox/error.hpp>
#include <string>
#include <string_view>

namespace pfvox::import::vdb {

namespace metadata {
inline constexpr std::string_view kPrefix = "pfvox_";
/// What the grid is: one of the three below.
inline constexpr std::string_view kRole = "pfvox_grid";
inline constexpr std::string_view kMaterialRole = "material";  ///< the model: numbers of materials
inline constexpr std::string_view kDensityRole = "density";    ///< 1 in every voxel, for other programs
inline constexpr std::string_view kColorRole = "color";        ///< linear colors, for other programs
inline constexpr std::string_view kModel = "pfvox_model";
inline constexpr std::string_view kInstance = "pfvox_instance";
inline constexpr std::string_view kHidden = "pfvox_hidden";  ///< "1": a hidden instance
inline constexpr std::string_view kLayer = "pfvox_layer";
inline constexpr std::string_view kLayerHidden = "pfvox_layer_hidden";  ///< "1": a hidden layer
inline constexpr std::string_view kVoxelSize = "pfvox_voxel_size";      ///< of the asset, in metres
inline constexpr std::string_view kMaterials = "pfvox_materials";       ///< a table, see materialTable()
}  // namespace metadata

/// String metadata of a grid whose name begins with the prefix.
using OwnMetadata = std::map<std::string, std::string, std::less<>>;

/// The number that stands for a material in the grid: 0 is empty space.
constexpr std::int32_t labelOfMaterial(std::size_t material) {
    return static_cast<std::int32_t>(material) + 1;
}

using MaterialTable = std::map<std::int64_t, Material>;

/// A line a material: its number, then `key=value` of everything that is not the default, at last the name,
/// to the end of the line, with \n and \\ for line break and backslash. Floats are spelled so that they come
/// back exactly.
std::string materialTable(const MaterialTable& materials);

/// The reverse. Errors: BadValue, with the number of the line.
Result<MaterialTable> parseMaterialTable(std::string_view text);

/// A float64 in the shortest spelling that comes back exactly, and the reverse: nothing where it is no finite
/// number above zero.
std::string spelledSize(double metres);
std::optional<double> parseSize(std::string_view text);

}  // namespace pfvox::import::vdb
