// What an imported asset shows in the world, cell by cell, so that tests can compare it with other sources.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <pfvox/voxel_model.hpp>
#include <string>
#include <utility>
#include <vector>

#include "support/independent_vox_reader.hpp"

namespace pfvox::test {

/// Every voxel of a model with its material, in no particular order.
inline std::vector<std::pair<glm::ivec3, MaterialIndex>> voxelsOf(const VoxelModel& model) {
    std::vector<std::pair<glm::ivec3, MaterialIndex>> voxels;
    for (const auto& region : model.regions()) {
        for (std::uint32_t c = 0; c < static_cast<std::uint32_t>(kRegionCells); ++c) {
            const Brick* brick = region->cell(c).brick;
            if (brick == nullptr) continue;
            const glm::ivec3 corner =
                region->coord() * kRegionEdge + glm::ivec3(mortonDecode(c)) * kBrickEdge;
            for (std::uint32_t m = 0; m < kBrickVoxels; ++m) {
                if (brick->occupied(m))
                    voxels.emplace_back(corner + glm::ivec3(mortonDecode(m)), brick->materials[m]);
            }
        }
    }
    return voxels;
}

/// The look of a material in the words of MagicaVoxel.
inline VoxelLook lookOf(const Material& m) {
    return {{m.baseColor.x, m.baseColor.y, m.baseColor.z, m.baseColor.w},
            std::string("_") + toString(m.type)};
}

/// The world cells of one instance in pfvox axes, found from the centers of its voxels; sorted.
inline std::vector<std::pair<Cell, VoxelLook>> worldCellsOf(const VoxelAsset& asset,
                                                            const Instance& instance) {
    std::vector<VoxelLook> looks;
    for (const Material& material : asset.materials) looks.push_back(lookOf(material));
    std::vector<std::pair<Cell, VoxelLook>> cells;
    for (const auto& [voxel, material] : voxelsOf(asset.models[instance.model])) {
        const glm::dvec3 metres = instance.worldFromModel * glm::dvec4(glm::dvec3(voxel) + 0.5, 1.0);
        const glm::dvec3 w = glm::floor(metres / asset.source.voxelSizeMetres);
        cells.push_back({{int(w.x), int(w.y), int(w.z)}, looks[material]});
    }
    std::ranges::sort(cells);
    return cells;
}

/// The same cells of the independent reader, turned into pfvox axes: cell (x, y, z) becomes (x, z, -y - 1).
inline std::vector<std::pair<Cell, VoxelLook>> worldCellsOf(const IndependentVoxReader::Instance& instance) {
    std::vector<std::pair<Cell, VoxelLook>> cells;
    for (const auto& [w, look] : instance.worldCells) cells.push_back({{w[0], w[2], -w[1] - 1}, look});
    std::ranges::sort(cells);
    return cells;
}

}  // namespace pfvox::test
