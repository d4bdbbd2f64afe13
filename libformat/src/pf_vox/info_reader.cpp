#include "pf_vox/info_reader.hpp"

#include <algorithm>
#include <cmath>

namespace pfvox {

namespace {

Result<NameList> readNames(std::span<const std::byte> file, const SectionIndex& index) {
    const layout::Section* section = index.find("NAME");
    if (section == nullptr) return fail(ErrorCode::BadStructure, "section NAME is missing");
    PFVOX_TRY(const auto, raw, readSection(file, *section, section->rawBytes));
    if (section->count >= raw.size() / sizeof(std::uint32_t)) {
        return failInSection(*section, ErrorCode::BadStructure, "more names than bytes");
    }
    const std::size_t textStart = (section->count + 1) * sizeof(std::uint32_t);
    const auto offsetAt = [&](std::size_t i) {
        std::uint32_t value = 0;
        std::memcpy(&value, raw.data() + i * sizeof value, sizeof value);
        return value;
    };
    std::vector<std::string> names;
    names.reserve(section->count);
    for (std::size_t i = 0; i < section->count; ++i) {
        const std::uint32_t begin = offsetAt(i);
        const std::uint32_t end = offsetAt(i + 1);
        if (begin > end || end > raw.size() - textStart) {
            return failInSection(*section, ErrorCode::BadStructure, fmt::format("name {} lies outside", i));
        }
        names.emplace_back(reinterpret_cast<const char*>(raw.data()) + textStart + begin, end - begin);
    }
    return NameList(std::move(names));
}

template <class... Float>
bool allFinite(Float... values) {
    return (std::isfinite(values) && ...);
}

Result<void> readMaterials(std::span<const std::byte> file, const SectionIndex& index, const Limits& limits,
                           const NameList& names, AssetInfo& info) {
    PFVOX_TRY(const auto, records, readRecords<layout::Material>(file, index, "MATL", limits.maxMaterials));
    for (const layout::Material& r : records) {
        if (r.type > static_cast<std::uint8_t>(MaterialType::Media) ||
            !allFinite(r.indexOfRefraction, r.emissionStrength, r.density)) {
            return failInSection(*index.find("MATL"), ErrorCode::BadValue,
                                 fmt::format("material {} has an unknown type or a value that is no number",
                                             info.materials.size()));
        }
        const auto unit = [](std::uint16_t v) { return static_cast<float>(v) / 65535.0f; };
        info.materials.push_back(
            {.baseColor = {r.baseColor[0], r.baseColor[1], r.baseColor[2], r.baseColor[3]},
             .type = static_cast<MaterialType>(r.type),
             .metalness = unit(r.metalness),
             .roughness = unit(r.roughness),
             .specular = unit(r.specular),
             .indexOfRefraction = r.indexOfRefraction,
             .emissionStrength = r.emissionStrength,
             .transparency = unit(r.transparency),
             .density = r.density,
             .phase = std::max(static_cast<float>(r.phase) / 32767.0f, -1.0f),
             .name = names.at(r.name)});
    }
    return {};
}

Result<void> readInstances(std::span<const std::byte> file, const SectionIndex& index, const Limits& limits,
                           const NameList& names, AssetInfo& info) {
    PFVOX_TRY(const auto, records, readRecords<layout::Instance>(file, index, "INST", limits.maxInstances));
    for (const layout::Instance& r : records) {
        Instance instance{.model = r.model,
                          .name = names.at(r.name),
                          .layer = r.layer,
                          .hidden = (r.flags & layout::kInstanceHidden) != 0};
        for (int row = 0; row < 3; ++row) {
            for (int column = 0; column < 4; ++column) {
                const float value = r.worldFromModel[static_cast<std::size_t>(4 * row + column)];
                if (!std::isfinite(value)) {
                    return failInSection(
                        *index.find("INST"), ErrorCode::BadValue,
                        fmt::format("the transform of instance {} is no number", info.instances.size()));
                }
                instance.worldFromModel[column][row] = static_cast<double>(value);
            }
        }
        info.instances.push_back(std::move(instance));
    }
    return {};
}

Result<void> readLayersAndCameras(std::span<const std::byte> file, const SectionIndex& index,
                                  const NameList& names, AssetInfo& info) {
    constexpr std::uint64_t kMaxRecords = 1u << 20;
    if (index.find("LAYR") != nullptr) {
        PFVOX_TRY(const auto, layers, readRecords<layout::Layer>(file, index, "LAYR", kMaxRecords));
        for (const layout::Layer& r : layers) {
            info.layers.push_back(
                {.name = names.at(r.name), .hidden = (r.flags & layout::kLayerHidden) != 0});
        }
    }
    if (index.find("CAMR") != nullptr) {
        PFVOX_TRY(const auto, cameras, readRecords<layout::Camera>(file, index, "CAMR", kMaxRecords));
        for (const layout::Camera& r : cameras) {
            info.cameras.push_back({.name = names.at(r.name),
                                    .position = {r.position[0], r.position[1], r.position[2]},
                                    .target = {r.target[0], r.target[1], r.target[2]},
                                    .fovYDegrees = static_cast<double>(r.fovYDegrees)});
        }
    }
    return {};
}

Result<void> readMeta(std::span<const std::byte> file, const SectionIndex& index, const NameList& names,
                      AssetInfo& info) {
    const layout::Section* section = index.find("META");
    if (section == nullptr) return fail(ErrorCode::BadStructure, "section META is missing");
    PFVOX_TRY(const auto, raw, readSection(file, *section, section->rawBytes));
    layout::Meta meta;
    if (raw.size() < sizeof meta) return failInSection(*section, ErrorCode::Truncated, "too short");
    std::memcpy(&meta, raw.data(), sizeof meta);
    if (raw.size() != sizeof meta + std::size_t{meta.noteCount} * sizeof(std::uint32_t)) {
        return failInSection(*section, ErrorCode::BadStructure, "the number of notes does not fit the size");
    }
    if (!std::isfinite(meta.voxelSizeMetres) || meta.voxelSizeMetres <= 0.0) {
        return failInSection(*section, ErrorCode::BadValue, "the voxel size is not positive");
    }
    info.source.voxelSizeMetres = meta.voxelSizeMetres;
    info.source.format = names.at(meta.format);
    for (std::size_t i = 0; i < meta.noteCount; ++i) {
        std::uint32_t name = 0;
        std::memcpy(&name, raw.data() + sizeof meta + i * sizeof name, sizeof name);
        info.source.notes.push_back(names.at(name));
    }
    return {};
}

}  // namespace

Result<void> readInfo(std::span<const std::byte> file, const SectionIndex& index, const Limits& limits,
                      NameList& names, AssetInfo& info) {
    PFVOX_TRY(NameList, list, readNames(file, index));
    names = std::move(list);
    PFVOX_CHECK(readMaterials(file, index, limits, names, info));
    PFVOX_CHECK(readInstances(file, index, limits, names, info));
    PFVOX_CHECK(readLayersAndCameras(file, index, names, info));
    return readMeta(file, index, names, info);
}

}  // namespace pfvox
