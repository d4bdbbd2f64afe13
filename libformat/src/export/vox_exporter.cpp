// The way through this folder: regions of octrees -> parts of at most 256^3 -> models, nodes and materials of
// a .vox file.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <pfvox/export.hpp>

#include "export/vox_writer.hpp"

namespace pfvox {

namespace {

using vox_file::VoxDict;
using vox_file::VoxVoxel;
using vox_file::VoxWriter;

constexpr std::size_t kMaxMaterials = 255;

/// From our frame (y up) to MagicaVoxel's (z up): (x, y, z) -> (x, -z, y).
glm::i64vec3 voxFromOurs(glm::i64vec3 p) {
    return {p.x, -p.z, p.y};
}
glm::i64vec3 oursFromVox(glm::i64vec3 p) {
    return {p.x, p.z, -p.y};
}

/// A region of a model, as one model of the .vox file.
struct Part {
    glm::i64vec3 corner;  ///< of its tight box, in model voxels
    glm::i64vec3 size;    ///< of that box
    std::uint32_t voxModel;
};

/// A quarter-turn rotation or mirror and a translation by whole voxels, in our frame.
struct GridPlacement {
    std::array<glm::i64vec3, 3> columns;
    glm::i64vec3 translation;

    glm::i64vec3 rotate(glm::i64vec3 v) const {
        return columns[0] * v.x + columns[1] * v.y + columns[2] * v.z;
    }
};

Result<GridPlacement> gridPlacement(const Instance& instance, std::size_t index, double voxelSizeMetres) {
    // Positions in a file are exact to a 4096th of a voxel (PF_VOX, INSX).
    constexpr double kTolerance = 1e-3;
    constexpr double kFarthest = 1 << 30;
    GridPlacement placement;
    bool exact = true;
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 3; ++row) {
            const double value = instance.worldFromModel[column][row] / voxelSizeMetres;
            const double whole = std::round(value);
            exact = exact && std::abs(value - whole) < kTolerance && std::abs(whole) <= kFarthest;
            auto& target =
                column < 3 ? placement.columns[static_cast<std::size_t>(column)] : placement.translation;
            target[row] = exact ? static_cast<std::int64_t>(whole) : 0;
        }
    }
    for (int axis = 0; axis < 3; ++axis) {
        std::int64_t inColumn = 0;
        std::int64_t inRow = 0;
        for (int other = 0; other < 3; ++other) {
            inColumn += std::abs(placement.columns[static_cast<std::size_t>(axis)][other]);
            inRow += std::abs(placement.columns[static_cast<std::size_t>(other)][axis]);
        }
        exact = exact && inColumn == 1 && inRow == 1;
    }
    if (!exact) {
        return fail(
            ErrorCode::UnsupportedFeature,
            fmt::format(
                "instance {} ('{}') is not turned by quarter turns and moved by whole voxels of {} m: "
                "a .vox file cannot place it",
                index, instance.name, voxelSizeMetres));
    }
    return placement;
}

/// The rotation byte of a frame: columns of the two first rows' entries, then the signs of the rows.
int rotationByte(const GridPlacement& placement) {
    int byte = 0;
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) {
            const glm::i64vec3 axis{column == 0, column == 1, column == 2};
            const std::int64_t entry = voxFromOurs(placement.rotate(oursFromVox(axis)))[row];
            if (entry == 0) continue;
            if (row < 2) byte |= column << (2 * row);
            if (entry < 0) byte |= 1 << (4 + row);
        }
    }
    return byte;
}

/// Where the pivot of a part goes (docs/import.md, "Placement"): R (c - o) + M (R b + T).
glm::i64vec3 voxTranslation(const GridPlacement& placement, const Part& part) {
    const glm::i64vec3 voxSize{part.size.x, part.size.z, part.size.y};
    const glm::i64vec3 fromCorner = voxSize / std::int64_t{2} - glm::i64vec3{0, part.size.z, 0};
    return voxFromOurs(placement.rotate(oursFromVox(fromCorner)) + placement.rotate(part.corner) +
                       placement.translation);
}

/// SIZE and XYZI of one region.
Part writePart(const OctreeModel& model, const OctreeRegion& region, std::uint32_t voxModel,
               VoxWriter& file) {
    const Part part{
        .corner = glm::i64vec3{region.bounds.min}, .size = region.bounds.size(), .voxModel = voxModel};
    std::vector<VoxVoxel> voxels;
    voxels.reserve(region.voxelCount);
    // Top-down in the order of MagicaVoxel's own files: z slowest, then y, then x.
    for (std::int64_t up = 0; up < part.size.y; ++up) {
        for (std::int64_t back = 0; back < part.size.z; ++back) {
            for (std::int64_t x = 0; x < part.size.x; ++x) {
                const glm::i64vec3 ours = part.corner + glm::i64vec3{x, up, part.size.z - 1 - back};
                const auto material = model.at(glm::ivec3{ours});
                if (!material) continue;
                voxels.push_back({static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(back),
                                  static_cast<std::uint8_t>(up), static_cast<std::uint8_t>(*material + 1)});
            }
        }
    }
    const glm::ivec3 size(part.size);
    file.model({size.x, size.z, size.y}, voxels);
    return part;
}

void writeNode(const Instance& instance, const GridPlacement& placement, const Part& part, int id,
               VoxWriter& file) {
    VoxDict attributes;
    if (!instance.name.empty()) attributes.emplace_back("_name", instance.name);
    if (instance.hidden) attributes.emplace_back("_hidden", "1");
    const glm::i64vec3 t = voxTranslation(placement, part);
    const VoxDict frame{{"_r", fmt::format("{}", rotationByte(placement))},
                        {"_t", fmt::format("{} {} {}", t.x, t.y, t.z)}};
    file.transform({.id = id,
                    .child = id + 1,
                    .frames = {frame},
                    .attributes = std::move(attributes),
                    .layer = instance.layer});
    file.shape({.id = id + 1, .models = {{static_cast<int>(part.voxModel), {}}}});
}

Result<void> writeGraph(const OctreeAsset& asset, const std::vector<std::vector<Part>>& parts,
                        VoxWriter& file) {
    constexpr int kFirstInstanceNode = 2;
    std::vector<std::int32_t> children;
    for (const Instance& instance : asset.instances)
        for (std::size_t i = 0; i < parts[instance.model].size(); ++i)
            children.push_back(kFirstInstanceNode + 2 * static_cast<std::int32_t>(children.size()));
    file.transform({.id = 0, .child = 1});
    file.group(1, children);

    int id = kFirstInstanceNode;
    for (std::size_t i = 0; i < asset.instances.size(); ++i) {
        PFVOX_TRY(const GridPlacement, placement,
                  gridPlacement(asset.instances[i], i, asset.source.voxelSizeMetres));
        for (const Part& part : parts[asset.instances[i].model]) {
            writeNode(asset.instances[i], placement, part, id, file);
            id += 2;
        }
    }
    return {};
}

const char* typeName(MaterialType type) {
    switch (type) {
        case MaterialType::Metal:
            return "_metal";
        case MaterialType::Glass:
            return "_glass";
        case MaterialType::Emit:
            return "_emit";
        case MaterialType::Plastic:
            return "_plastic";
        case MaterialType::Blend:
            return "_blend";
        case MaterialType::Media:
            return "_media";
        case MaterialType::Diffuse:
            break;
    }
    return "_diffuse";
}

/// Strength = _emit x 10^_flux with _emit at most 1.
void addEmission(float strength, VoxDict& dict) {
    const int flux = strength > 1.0f ? static_cast<int>(std::ceil(std::log10(strength))) : 0;
    dict.emplace_back("_emit", fmt::format("{}", strength / std::pow(10.0f, static_cast<float>(flux))));
    dict.emplace_back("_flux", fmt::format("{}", flux));
}

/// The MATL dictionary of MagicaVoxel (docs/import.md has the mapping back).
VoxDict matlOf(const Material& material) {
    VoxDict dict{{"_type", typeName(material.type)}};
    const auto add = [&](const char* key, float value) { dict.emplace_back(key, fmt::format("{}", value)); };
    add("_rough", material.roughness);
    add("_spec", material.specular);
    add("_ior", material.indexOfRefraction - 1.0f);
    add("_metal", material.metalness);
    if (material.type == MaterialType::Emit) addEmission(material.emissionStrength, dict);
    add("_trans", material.transparency);
    add("_d", material.density);
    add("_g", material.phase);
    return dict;
}

void writeMaterials(const OctreeAsset& asset, VoxWriter& file) {
    for (std::size_t i = 0; i < asset.layers.size(); ++i) {
        const Layer& layer = asset.layers[i];
        VoxDict attributes{{"_name", layer.name.str()}};
        if (layer.hidden) attributes.emplace_back("_hidden", "1");
        file.layer(static_cast<int>(i), attributes);
    }
    std::array<std::array<std::uint8_t, 4>, kMaxMaterials + 1> palette;
    palette.fill({0, 0, 0, 255});
    for (std::size_t i = 0; i < asset.materials.size(); ++i) {
        const glm::u8vec4 c = asset.materials[i].baseColor;
        palette[i] = {c.x, c.y, c.z, c.w};
    }
    file.palette(palette);
    for (std::size_t i = 0; i < asset.materials.size(); ++i)
        file.material(static_cast<int>(i) + 1, matlOf(asset.materials[i]));
}

}  // namespace

Result<std::vector<std::byte>> exportVox(const OctreeAsset& asset, Diagnostics& diagnostics) {
    if (asset.materials.size() > kMaxMaterials) {
        return fail(ErrorCode::LimitExceeded, fmt::format("{} materials; a .vox file has room for {}",
                                                          asset.materials.size(), kMaxMaterials));
    }
    VoxWriter file;
    std::vector<std::vector<Part>> parts(asset.models.size());
    std::uint32_t voxModel = 0;
    bool named = false;
    for (std::size_t m = 0; m < asset.models.size(); ++m) {
        for (const OctreeRegion& region : asset.models[m].regions) {
            parts[m].push_back(writePart(asset.models[m], region, voxModel++, file));
        }
    }
    if (voxModel == 0) return fail(ErrorCode::NothingToConvert, "the asset holds no voxel");
    PFVOX_CHECK(writeGraph(asset, parts, file));
    writeMaterials(asset, file);
    for (const Material& material : asset.materials) named = named || !material.name.empty();
    if (named) diagnostics.note("export-vox-precision", "names of materials have no place in a .vox file");
    const std::string bytes = file.finish();
    const auto all = std::as_bytes(std::span(bytes));
    return std::vector<std::byte>(all.begin(), all.end());
}

}  // namespace pfvox
