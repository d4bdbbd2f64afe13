#include "pf_vox/info_reader.hpp"

#include <algorithm>
#include <cstring>

namespace pfvox {

namespace {

using container::MemoryBudget;

template <class T>
Result<void> assign(T& target, Result<T> result) {
    if (!result) return tl::make_unexpected(std::move(result).error());
    target = *std::move(result);
    return {};
}

Material toMaterial(const layout::Material& r, const NamePool& names) {
    const auto fraction = [](std::uint16_t v) { return static_cast<float>(v) / 65535.0f; };
    return {.baseColor = {r.baseColor[0], r.baseColor[1], r.baseColor[2], r.baseColor[3]},
            .type = static_cast<MaterialType>(r.type),
            .metalness = fraction(r.metalness),
            .roughness = fraction(r.roughness),
            .specular = fraction(r.specular),
            .indexOfRefraction = r.indexOfRefraction,
            .emissionStrength = r.emissionStrength,
            .transparency = fraction(r.transparency),
            .density = r.density,
            .phase = std::max(static_cast<float>(r.phase) / 32767.0f, -1.0f),
            .name = names.at(r.name)};
}

Instance toInstance(const layout::Instance& r, const NamePool& names) {
    Instance instance{.model = r.model,
                      .name = names.at(r.name),
                      .layer = r.layer,
                      .hidden = (r.flags & layout::kInstanceHidden) != 0};
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 4; ++column) {
            instance.worldFromModel[column][row] =
                static_cast<double>(r.worldFromModel[static_cast<std::size_t>(4 * row + column)]);
        }
    }
    return instance;
}

Result<void> makeCameras(const InfoRecords& records, MemoryBudget& budget, std::vector<Camera>& cameras) {
    PFVOX_CHECK(budget.reserve(cameras, records.cameras.size()));
    for (const layout::Camera& r : records.cameras) {
        const Name name = records.names.at(r.name);
        PFVOX_CHECK(budget.take(name.size()));
        cameras.push_back({.name = name.str(),
                           .position = {r.position[0], r.position[1], r.position[2]},
                           .target = {r.target[0], r.target[1], r.target[2]},
                           .fovYDegrees = static_cast<double>(r.fovYDegrees)});
    }
    return {};
}

/// META has its notes behind it.
Result<void> readMeta(const PfVoxSections& sections, InfoRecords& records) {
    PFVOX_TRY(const layout::Section*, section, sections.table.require("META"));
    PFVOX_TRY(const auto, raw, sections.reader.read<std::byte>(*section, section->rawBytes));
    layout::Meta& meta = records.meta;
    if (raw.size() < sizeof meta)
        return container::failInSection(*section, ErrorCode::Truncated, "too short");
    std::memcpy(&meta, raw.data(), sizeof meta);
    if (raw.size() != sizeof meta + std::size_t{meta.noteCount} * sizeof(std::uint32_t)) {
        return container::failInSection(*section, ErrorCode::BadStructure,
                                        "the number of notes does not fit the size");
    }
    auto notes = container::Array<std::uint32_t>::make(sections.reader.budget(), meta.noteCount);
    if (!notes) return container::inSection(*section, tl::make_unexpected(notes.error()));
    records.notes = *std::move(notes);
    if (!records.notes.empty())
        std::memcpy(records.notes.data(), raw.data() + sizeof meta, raw.size() - sizeof meta);
    return {};
}

}  // namespace

Result<InfoRecords> readInfo(const PfVoxSections& sections, const Limits& limits) {
    InfoRecords records;
    PFVOX_TRY(const layout::Section*, names, sections.table.require("NAME"));
    PFVOX_CHECK(assign(records.names, NamePool::read(sections.reader, *names)));
    PFVOX_CHECK(assign(records.materials, sections.readTable<layout::Material>("MATL", limits.maxMaterials)));
    PFVOX_CHECK(assign(records.instances, sections.readTable<layout::Instance>("INST", limits.maxInstances)));
    if (const layout::Section* const exact = sections.table.find("INSX")) {
        PFVOX_CHECK(assign(records.places, sections.readTable<layout::Place>("INSX", limits.maxInstances)));
        if (records.places.size() != records.instances.size())
            return container::failInSection(*exact, ErrorCode::BadStructure, "has not one entry an instance");
    }
    if (sections.table.find("LAYR") != nullptr)
        PFVOX_CHECK(assign(records.layers, sections.readTable<layout::Layer>("LAYR", layout::kMaxLayers)));
    if (sections.table.find("CAMR") != nullptr)
        PFVOX_CHECK(assign(records.cameras, sections.readTable<layout::Camera>("CAMR", layout::kMaxLayers)));
    PFVOX_CHECK(readMeta(sections, records));
    return records;
}

Result<void> makeInfo(const InfoRecords& records, MemoryBudget& budget, AssetInfo& info) {
    const NamePool& names = records.names;
    PFVOX_CHECK(budget.reserve(info.materials, records.materials.size()));
    for (const layout::Material& r : records.materials) info.materials.push_back(toMaterial(r, names));
    PFVOX_CHECK(budget.reserve(info.instances, records.instances.size()));
    for (std::size_t i = 0; i < records.instances.size(); ++i) {
        info.instances.push_back(toInstance(records.instances[i], names));
        if (records.places.empty()) continue;
        const auto& t = records.places[i].translation;
        info.instances.back().worldFromModel[3] = {t[0], t[1], t[2]};
    }
    PFVOX_CHECK(budget.reserve(info.layers, records.layers.size()));
    for (const layout::Layer& r : records.layers)
        info.layers.push_back({.name = names.at(r.name), .hidden = (r.flags & layout::kLayerHidden) != 0});
    PFVOX_CHECK(makeCameras(records, budget, info.cameras));
    info.source.voxelSizeMetres = records.meta.voxelSizeMetres;
    info.source.format = names.at(records.meta.format);
    PFVOX_CHECK(budget.reserve(info.source.notes, records.notes.size()));
    for (const std::uint32_t note : records.notes) info.source.notes.push_back(names.at(note));
    return {};
}

}  // namespace pfvox
