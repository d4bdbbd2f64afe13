#include "import/asset_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <pfvox/text_encoding.hpp>

namespace pfvox::import {

namespace {

void makeNamesUtf8(VoxelAsset& asset, Diagnostics& diagnostics) {
    std::size_t converted = 0;
    std::string first;
    const auto convert = [&](auto& name) {
        if (isUtf8(name)) return;
        name = utf8FromWindows1252(name);
        if (converted++ == 0) first = name;
    };
    for (VoxelModel& model : asset.models) convert(model.name);
    for (Instance& instance : asset.instances) convert(instance.name);
    for (Layer& layer : asset.layers) convert(layer.name);
    for (Camera& camera : asset.cameras) convert(camera.name);
    for (Material& material : asset.materials) convert(material.name);
    for (Name& note : asset.source.notes) convert(note);
    if (converted == 0) return;
    diagnostics.warn(
        "name-encoding",
        fmt::format("{} of the file are not UTF-8 and were read as Windows-1252; the first became \"{}\"",
                    converted == 1 ? "1 name" : fmt::format("{} names", converted), first));
}

void countEmptyModels(const VoxelAsset& asset, Diagnostics& diagnostics) {
    const auto empty = static_cast<std::size_t>(
        std::ranges::count_if(asset.models, [](const VoxelModel& model) { return model.voxelCount() == 0; }));
    if (empty == 0) return;
    if (empty == asset.models.size()) {
        diagnostics.warn("empty-models", "no model of the file has a voxel");
    } else {
        diagnostics.note("empty-models",
                         fmt::format("{} of {} models have no voxel", empty, asset.models.size()));
    }
}

}  // namespace

void checkAsset(VoxelAsset& asset, Diagnostics& diagnostics) {
    makeNamesUtf8(asset, diagnostics);
    countEmptyModels(asset, diagnostics);
}

}  // namespace pfvox::import
