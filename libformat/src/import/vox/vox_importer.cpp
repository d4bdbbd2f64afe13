// The way through this folder: chunks -> VoxFile -> instances -> models -> VoxelAsset.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <cmath>

#include "import/importer.hpp"
#include "import/merge.hpp"
#include "import/vox/instances.hpp"
#include "import/vox/model_set.hpp"
#include "import/vox/slab6.hpp"
#include "import/vox/vox_file.hpp"

namespace pfvox::import {

namespace vox {

namespace {

/// A file named .vox that has the chunks of MagicaVoxel behind a damaged start.
bool hasDamagedMagic(std::span<const std::byte> bytes) {
    constexpr std::size_t kSearchedBytes = 16;
    return io::asText(bytes.first(std::min(bytes.size(), kSearchedBytes))).find("MAIN") !=
           std::string_view::npos;
}

bool recognises(const SourceBytes& source) {
    if (io::asText(source.bytes).starts_with("VOX ")) return true;
    const bool isNamedVox = source.file.extension() == ".vox" || source.file.extension() == ".VOX";
    return isNamedVox && (hasDamagedMagic(source.bytes) || isSlab6(source.bytes));
}

std::vector<bool> modelsIn(const std::vector<GridInstance>& instances, std::size_t modelCount) {
    std::vector<bool> shown(modelCount, false);
    for (const GridInstance& instance : instances) shown[instance.model] = true;
    return shown;
}

void reportUnshownModels(const std::vector<bool>& shown, const ImportSettings& settings,
                         Diagnostics& diagnostics) {
    const auto count = std::ranges::count(shown, false);
    if (count == 0) return;
    const bool kept = settings.includeHidden && !settings.merge;
    diagnostics.note("vox-unused-models",
                     fmt::format("{} of {} models are shown by no instance and are {}", count, shown.size(),
                                 kept ? "kept without one" : "left out"));
}

/// The 255 colors with their materials, in the order of palette indices.
std::vector<Material> makeMaterials(const VoxFile& file) {
    std::vector<Material> materials;
    for (std::size_t v = 1; v < kPaletteSize; ++v) {
        materials.push_back(file.materials[v].material);
        materials.back().baseColor = file.palette[v];
    }
    return materials;
}

void reportMaterials(const VoxFile& file, const std::array<bool, kPaletteSize>& usedIndices,
                     Diagnostics& diagnostics) {
    std::set<std::string> unmapped;
    std::set<std::string> malformed;
    int approximated = 0;
    int translucent = 0;
    for (std::size_t v = 1; v < kPaletteSize; ++v) {
        if (!usedIndices[v]) continue;
        const MaterialRecord& record = file.materials[v];
        unmapped.insert(record.unmappedKeys.begin(), record.unmappedKeys.end());
        malformed.insert(record.malformedKeys.begin(), record.malformedKeys.end());
        if (file.palette[v].a != 255) ++translucent;
        const MaterialType type = record.material.type;
        if (type == MaterialType::Blend || type == MaterialType::Media) ++approximated;
    }
    if (!unmapped.empty()) {
        diagnostics.note("vox-material-unmapped", fmt::format("material properties without a counterpart: {}",
                                                              fmt::join(unmapped, ", ")));
    }
    if (!malformed.empty()) {
        diagnostics.warn(
            "vox-material-malformed",
            fmt::format("material properties that are no number or out of range, replaced by the default "
                        "or the nearest bound: {}",
                        fmt::join(malformed, ", ")));
    }
    if (translucent > 0) {
        diagnostics.warn("vox-palette-alpha", fmt::format("{} of the colors used have an alpha below 255, "
                                                          "which MagicaVoxel draws opaque; their voxels do "
                                                          "not count as opaque",
                                                          translucent));
    }
    if (approximated > 0) {
        diagnostics.note("vox-material-approximated",
                         fmt::format("{} materials of type blend or media are drawn as glass", approximated));
    }
}

/// `indexOfLayer` gets the position of each layer id in the result.
std::vector<Layer> makeLayers(const SceneGraph& graph, const ImportSettings& settings,
                              std::map<std::int32_t, std::int32_t>& indexOfLayer) {
    std::vector<Layer> layers;
    for (const auto& [id, record] : graph.layers) {
        indexOfLayer.emplace(id, static_cast<std::int32_t>(layers.size()));
        layers.push_back(
            {.name = std::string(record.name), .hidden = record.hidden && !settings.includeHidden});
    }
    return layers;
}

Result<void> checkInstanceMemory(const std::vector<GridInstance>& instances, const Limits& limits) {
    std::uint64_t bytes = 0;
    for (const GridInstance& instance : instances) bytes += sizeof(Instance) + instance.name.size();
    if (bytes > limits.maxMemoryBytes) {
        return fail(ErrorCode::LimitExceeded,
                    fmt::format("the instances take {} bytes (limit maxMemoryBytes is {})", bytes,
                                limits.maxMemoryBytes));
    }
    return {};
}

/// Moves the wanted models to the asset and places them.
void addModels(std::vector<VoxelModel> models, const std::vector<bool>& wanted,
               const std::vector<GridInstance>& instances,
               const std::map<std::int32_t, std::int32_t>& indexOfLayer, VoxelAsset& asset) {
    std::vector<std::uint32_t> indexOfModel(models.size(), 0);
    for (std::size_t id = 0; id < models.size(); ++id) {
        if (!wanted[id]) continue;
        indexOfModel[id] = static_cast<std::uint32_t>(asset.models.size());
        asset.models.push_back(std::move(models[id]));
    }
    for (const GridInstance& instance : instances) {
        const std::uint32_t model = indexOfModel[instance.model];
        const auto layer = indexOfLayer.find(instance.layerId);
        if (asset.models[model].name.empty()) asset.models[model].name = instance.name;
        asset.instances.push_back(
            {.model = model,
             .worldFromModel = instance.worldFromModel.toAffine(asset.source.voxelSizeMetres),
             .name = std::string(instance.name),
             .layer = layer == indexOfLayer.end() ? -1 : layer->second,
             .hidden = false});
    }
}

Result<void> addMerged(const std::vector<VoxelModel>& models, const std::vector<GridInstance>& instances,
                       const Limits& limits, VoxelAsset& asset, Diagnostics& diagnostics) {
    std::vector<PlacedModel> placed;
    for (const GridInstance& instance : instances) {
        placed.push_back({.model = instance.model, .mergedFromModel = instance.worldFromModel});
    }
    PFVOX_TRY(MergedModel, merged, mergeModels(models, placed, limits));
    if (merged.replacedVoxels > 0) {
        diagnostics.warn("vox-overlap",
                         fmt::format("{} voxels lie where a later instance has one too, which replaces them",
                                     merged.replacedVoxels));
    }
    asset.models.push_back(std::move(merged.model));
    asset.instances.push_back({.model = 0,
                               .worldFromModel = GridTransform{}.toAffine(asset.source.voxelSizeMetres),
                               .name = {},
                               .layer = -1,
                               .hidden = false});
    return {};
}

Result<VoxelAsset> importVox(const SourceBytes& source, const ImportSettings& settings, const Limits& limits,
                             Diagnostics& diagnostics) {
    if (isSlab6(source.bytes)) {
        return fail(ErrorCode::UnsupportedFormat,
                    "this is a SLAB6 model (dense voxels, 6-bit palette), not a MagicaVoxel file, although "
                    "both are named "
                    ".vox; open it in MagicaVoxel or SLAB6 and export it again");
    }
    const double voxelSizeMetres = settings.voxelSizeMetres.value_or(kDefaultVoxelSizeMetres);
    if (!(voxelSizeMetres > 0.0) || !std::isfinite(voxelSizeMetres)) {
        return fail(ErrorCode::BadValue,
                    fmt::format("a voxel of {} m is impossible: give a size above 0", voxelSizeMetres));
    }
    PFVOX_TRY(VoxFile, file, readVoxFile(source.bytes, voxelSizeMetres, limits, diagnostics));
    PFVOX_TRY(const std::vector<GridInstance>, instances, findInstances(file, settings, limits, diagnostics));
    PFVOX_CHECK(checkInstanceMemory(instances, limits));

    std::vector<bool> wanted = modelsIn(instances, file.models.size());
    if (!file.graph.nodes.empty()) reportUnshownModels(wanted, settings, diagnostics);
    if (settings.includeHidden && !settings.merge) wanted.assign(wanted.size(), true);
    PFVOX_TRY(ModelSet, set, buildModels(file.models, wanted, limits, diagnostics));

    VoxelAsset asset;
    asset.source = {.format = "vox", .voxelSizeMetres = voxelSizeMetres, .notes = std::move(file.notes)};
    asset.cameras = std::move(file.cameras);
    asset.materials = makeMaterials(file);
    reportMaterials(file, set.usedIndices, diagnostics);
    if (settings.merge) {
        PFVOX_CHECK(addMerged(set.models, instances, limits, asset, diagnostics));
    } else {
        std::map<std::int32_t, std::int32_t> indexOfLayer;
        asset.layers = makeLayers(file.graph, settings, indexOfLayer);
        addModels(std::move(set.models), wanted, instances, indexOfLayer, asset);
    }
    return asset;
}

}  // namespace

}  // namespace vox

Importer voxImporter() {
    return {.format = {.id = "vox", .title = "MagicaVoxel", .extension = ".vox"},
            .recognises = vox::recognises,
            .import = vox::importVox};
}

}  // namespace pfvox::import
