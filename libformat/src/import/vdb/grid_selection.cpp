#include "import/vdb/grid_selection.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

namespace pfvox::import::vdb {

namespace {

std::string lowerCase(std::string text) {
    std::ranges::transform(text, text.begin(),
                           [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
    return text;
}

bool isColorName(const std::string& name) {
    constexpr std::array<std::string_view, 9> kNames{"cd",  "color",   "colour", "colorgrid", "color_rgb",
                                                     "rgb", "diffuse", "albedo", "basecolor"};
    return std::ranges::find(kNames, lowerCase(name)) != kNames.end();
}

/// How programs name the float grids of red, green and blue: Blender's smoke has color_r, vectors that were
/// split into components have Cd.x or Cd.r.
constexpr std::array<std::array<std::string_view, 3>, 4> kChannelSuffixes{
    {{"_r", "_g", "_b"}, {".r", ".g", ".b"}, {".x", ".y", ".z"}, {"_x", "_y", "_z"}}};

std::string nameAndType(const GridDescriptor& grid) {
    return fmt::format("grid \"{}\" ({})", grid.displayName, grid.type);
}

/// Why a grid cannot be a model, with the remedy; empty when it can.
std::string obstacle(const GridDescriptor& grid) {
    switch (kindOf(grid)) {
        case GridKind::Points:
            return nameAndType(grid) + " holds points, not voxels: rasterise them to a density grid first";
        case GridKind::Other:
            return nameAndType(grid) +
                   " is of a type that makes no voxel model: float, double, bool, mask, int32 and int64 "
                   "grids do";
        case GridKind::Vector:
            if (!isColorName(grid.plainName())) {
                return nameAndType(grid) + " holds vectors: they are used only as colors, named Cd or color";
            }
            break;
        default:
            break;
    }
    if (grid.transformType == "NonlinearFrustumMap") {
        return nameAndType(grid) +
               " lives in a frustum, whose voxels are no cubes: resample it to a uniform grid first";
    }
    if (grid.treePos == 0)
        return fmt::format("{} has a transform of unknown type {}", nameAndType(grid), grid.transformType);
    return {};
}

bool isFloat(const GridDescriptor& grid) {
    return grid.type == "Tree_float_5_4_3" && obstacle(grid).empty();
}

/// The three float grids that give colors together, or none.
std::vector<std::size_t> findChannels(const std::vector<GridDescriptor>& grids) {
    std::map<std::string, std::size_t> floats;
    for (std::size_t i = 0; i < grids.size(); ++i) {
        if (isFloat(grids[i])) floats.emplace(lowerCase(grids[i].plainName()), i);
    }
    const auto find = [&](const std::string& name) {
        const auto at = floats.find(name);
        return at == floats.end() ? grids.size() : at->second;
    };
    for (const auto& [name, index] : floats) {
        for (const auto& [red, green, blue] : kChannelSuffixes) {
            if (!name.ends_with(red)) continue;
            const std::string base = name.substr(0, name.size() - red.size());
            if (!isColorName(base)) continue;
            const std::vector<std::size_t> found{find(name), find(base + std::string(green)),
                                                 find(base + std::string(blue))};
            if (std::ranges::find(found, grids.size()) == found.end()) return found;
        }
    }
    return {};
}

/// Of an export of pfvox: what only repeats the grids of materials.
bool repeatsMaterials(const GridDescriptor& grid) {
    const std::string_view role = grid.ownText(metadata::kRole);
    return role == metadata::kDensityRole || role == metadata::kColorRole;
}

std::string listOf(const std::vector<GridDescriptor>& grids) {
    std::string list;
    for (const GridDescriptor& grid : grids)
        list += fmt::format("{}\"{}\"", list.empty() ? "" : ", ", grid.displayName);
    return list.empty() ? "none" : list;
}

Result<std::vector<std::size_t>> chooseByName(const std::vector<GridDescriptor>& grids,
                                              const std::vector<std::string>& names) {
    std::vector<std::size_t> chosen;
    for (const std::string& name : names) {
        bool found = false;
        for (std::size_t i = 0; i < grids.size(); ++i) {
            if (grids[i].displayName != name && grids[i].plainName() != name) continue;
            found = true;
            if (std::string reason = obstacle(grids[i]); !reason.empty()) {
                return fail(ErrorCode::UnsupportedFeature, std::move(reason));
            }
            if (std::ranges::find(chosen, i) == chosen.end()) chosen.push_back(i);
        }
        if (!found) {
            return fail(ErrorCode::BadReference,
                        fmt::format("no grid is named \"{}\"; there are: {}", name, listOf(grids)));
        }
    }
    return chosen;
}

Result<std::vector<std::size_t>> chooseUsable(const std::vector<GridDescriptor>& grids,
                                              Diagnostics& diagnostics) {
    std::vector<std::size_t> chosen;
    std::vector<std::size_t> vectors;
    std::vector<std::string> obstacles;
    const std::vector<std::size_t> channels = findChannels(grids);
    const bool hasMaterials = std::ranges::any_of(grids, [](const GridDescriptor& grid) {
        return grid.ownText(metadata::kRole) == metadata::kMaterialRole && obstacle(grid).empty();
    });
    for (std::size_t i = 0; i < grids.size(); ++i) {
        if (hasMaterials && repeatsMaterials(grids[i])) continue;
        if (std::ranges::find(channels, i) != channels.end()) continue;
        if (std::string reason = obstacle(grids[i]); !reason.empty()) {
            obstacles.push_back(std::move(reason));
        } else {
            (kindOf(grids[i]) == GridKind::Vector ? vectors : chosen).push_back(i);
        }
    }
    // Colors alone still say where something is, and vectors say it best.
    if (chosen.empty()) chosen = vectors.empty() ? channels : std::move(vectors);
    if (chosen.empty() && !obstacles.empty()) return fail(ErrorCode::UnsupportedFeature, obstacles.front());
    if (chosen.empty()) return fail(ErrorCode::NothingToConvert, "the file holds no grid");
    for (std::string& reason : obstacles) diagnostics.warn("vdb-grid-skipped", std::move(reason));
    if (chosen.size() > 1) {
        diagnostics.note("vdb-several-grids",
                         fmt::format("{} grids become a model each; vdb.grid chooses among: {}",
                                     chosen.size(), listOf(grids)));
    }
    return chosen;
}

}  // namespace

GridKind kindOf(const GridDescriptor& grid) {
    constexpr std::string_view kPrefix = "Tree_";
    constexpr std::string_view kStandardTree = "_5_4_3";
    std::string_view type = grid.type;
    if (type.find("ptdataidx") != type.npos || type.find("ptidx") != type.npos) return GridKind::Points;
    if (!type.starts_with(kPrefix) || !type.ends_with(kStandardTree)) return GridKind::Other;
    type.remove_prefix(kPrefix.size());
    type.remove_suffix(kStandardTree.size());
    if (type == "float" || type == "double") return GridKind::Scalar;
    if (type == "bool" || type == "mask") return GridKind::Topology;
    if (type == "int32" || type == "int64") return GridKind::Integer;
    if (type == "vec3s" || type == "vec3d") return GridKind::Vector;
    return GridKind::Other;
}

Result<GridSelection> selectGrids(const std::vector<GridDescriptor>& grids,
                                  const std::vector<std::string>& names, Diagnostics& diagnostics) {
    PFVOX_TRY(auto, models, names.empty() ? chooseUsable(grids, diagnostics) : chooseByName(grids, names));
    GridSelection selection{.models = std::move(models), .color = {}};
    const bool colorable = std::ranges::any_of(
        selection.models, [&](std::size_t i) { return kindOf(grids[i]) != GridKind::Integer; });
    if (!colorable) return selection;
    for (std::size_t i = 0; i < grids.size() && selection.color.empty(); ++i) {
        if (kindOf(grids[i]) == GridKind::Vector && obstacle(grids[i]).empty()) selection.color = {i};
    }
    if (selection.color.empty()) selection.color = findChannels(grids);
    return selection;
}

}  // namespace pfvox::import::vdb
