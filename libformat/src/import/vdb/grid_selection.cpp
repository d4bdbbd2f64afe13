#include "import/vdb/grid_selection.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

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
                return nameAndType(grid) + " holds vectors: they are used only as colours, named Cd or color";
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
    std::vector<std::size_t> colors;
    std::vector<std::string> obstacles;
    for (std::size_t i = 0; i < grids.size(); ++i) {
        if (std::string reason = obstacle(grids[i]); !reason.empty()) {
            obstacles.push_back(std::move(reason));
        } else {
            (kindOf(grids[i]) == GridKind::Vector ? colors : chosen).push_back(i);
        }
    }
    // Colours alone still say where something is.
    if (chosen.empty()) chosen = std::move(colors);
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
    GridSelection selection{.models = std::move(models), .color = std::nullopt};
    for (std::size_t i = 0; i < grids.size(); ++i) {
        if (kindOf(grids[i]) != GridKind::Vector || !obstacle(grids[i]).empty()) continue;
        selection.color = i;
        break;
    }
    return selection;
}

}  // namespace pfvox::import::vdb
