// encodePfVox: an OctreeAsset as sections. What can be computed from the masks is not written
// (node_planes.hpp).
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <pfvox/pf_vox.hpp>

#include "octree/node_planes.hpp"
#include "pf_vox/layout.hpp"
#include "pf_vox/region_writer.hpp"
#include "pf_vox/section_writer.hpp"

namespace pfvox {

namespace {

/// The NAME section: every different string once; index 0 is the empty string.
class NameTable {
  public:
    NameTable() { add(""); }

    std::uint32_t add(const std::string& name) {
        const auto [entry, isNew] = indexOf_.try_emplace(name, static_cast<std::uint32_t>(names_.size()));
        if (isNew) names_.push_back(name);
        return entry->second;
    }
    SectionContent section() const {
        SectionContent s{.fourcc = "NAME", .count = names_.size()};
        std::uint32_t end = 0;
        const auto append = [&](std::uint32_t value) {
            const auto* bytes = reinterpret_cast<const std::uint8_t*>(&value);
            s.raw.insert(s.raw.end(), bytes, bytes + sizeof value);
        };
        append(end);
        for (const std::string& name : names_) append(end += static_cast<std::uint32_t>(name.size()));
        for (const std::string& name : names_) s.raw.insert(s.raw.end(), name.begin(), name.end());
        return s;
    }

  private:
    std::map<std::string, std::uint32_t> indexOf_;
    std::vector<std::string> names_;
};

template <class Record>
SectionContent recordSection(std::string_view fourcc, const std::vector<Record>& records) {
    SectionContent section{.fourcc = fourcc, .count = records.size()};
    section.raw.resize(records.size() * sizeof(Record));
    if (!records.empty()) std::memcpy(section.raw.data(), records.data(), section.raw.size());
    return section;
}

std::uint16_t unorm16(float v) {
    return static_cast<std::uint16_t>(std::lround(std::clamp(v, 0.0f, 1.0f) * 65535.0f));
}

std::array<std::int32_t, 3> toArray(glm::ivec3 v) {
    return {v.x, v.y, v.z};
}

layout::Material toLayout(const Material& m, NameTable& names) {
    return {.baseColor = {m.baseColor.x, m.baseColor.y, m.baseColor.z, m.baseColor.w},
            .type = static_cast<std::uint8_t>(m.type),
            .reserved = 0,
            .phase = static_cast<std::int16_t>(std::lround(std::clamp(m.phase, -1.0f, 1.0f) * 32767.0f)),
            .metalness = unorm16(m.metalness),
            .roughness = unorm16(m.roughness),
            .specular = unorm16(m.specular),
            .transparency = unorm16(m.transparency),
            .indexOfRefraction = m.indexOfRefraction,
            .emissionStrength = m.emissionStrength,
            .density = m.density,
            .name = names.add(m.name)};
}

layout::Instance toLayout(const Instance& instance, NameTable& names) {
    layout::Instance record{.worldFromModel = {},
                            .model = instance.model,
                            .name = names.add(instance.name),
                            .layer = instance.layer,
                            .flags = instance.hidden ? layout::kInstanceHidden : 0};
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 4; ++column) {
            record.worldFromModel[static_cast<std::size_t>(4 * row + column)] =
                static_cast<float>(instance.worldFromModel[column][row]);
        }
    }
    return record;
}

layout::Model toLayout(const OctreeModel& model, std::uint32_t firstRegion, NameTable& names) {
    const VoxelBox box = model.bounds.empty() ? VoxelBox{glm::ivec3{0}, glm::ivec3{0}} : model.bounds;
    return {.voxelCount = model.voxelCount,
            .origin = toArray(model.originVoxels),
            .boundsMin = toArray(box.min),
            .boundsMax = toArray(box.max),
            .depth = model.depth,
            .name = names.add(model.name),
            .firstRegion = firstRegion,
            .regionCount = static_cast<std::uint32_t>(model.regions.size()),
            .topNodeCount = static_cast<std::uint32_t>(model.topTree.nodes.size()),
            .topBranchCount = static_cast<std::uint32_t>(octree::countBranches(model.topTree)),
            .topFarCount = static_cast<std::uint32_t>(model.topTree.farTable.size()),
            .reserved = {}};
}

layout::Region toLayout(const OctreeRegion& region, std::uint32_t paletteFirst) {
    const auto local = [&](glm::ivec3 p) {
        const glm::ivec3 q = p - region.originVoxels;
        return std::array<std::uint16_t, 3>{static_cast<std::uint16_t>(q.x), static_cast<std::uint16_t>(q.y),
                                            static_cast<std::uint16_t>(q.z)};
    };
    return {.origin = toArray(region.originVoxels),
            .depth = region.tree.depth,
            .nodeCount = static_cast<std::uint32_t>(region.tree.nodes.size()),
            .branchCount = static_cast<std::uint32_t>(octree::countBranches(region.tree)),
            .farCount = static_cast<std::uint32_t>(region.tree.farTable.size()),
            .valueCount = static_cast<std::uint32_t>(region.valueCount()),
            .paletteFirst = paletteFirst,
            .paletteCount = static_cast<std::uint32_t>(region.palette.size()),
            .voxelCount = static_cast<std::uint32_t>(region.voxelCount),
            .boundsMin = local(region.bounds.min),
            .boundsMax = local(region.bounds.max),
            .reserved = {}};
}

Result<void> checkLod(const OctreeRegion& region, std::size_t materialCount) {
    if (region.lod.empty()) return {};
    const std::size_t n = region.tree.nodes.size();
    if (region.lod.colors.size() != n || region.lod.materials.size() != n) {
        return fail(ErrorCode::BadReference, "a level of detail has another number of nodes than its tree");
    }
    if (std::ranges::max(region.lod.materials) >= region.palette.size() ||
        std::ranges::max(region.palette) >= materialCount) {
        return fail(ErrorCode::BadReference, "a level of detail has a material that does not exist");
    }
    return {};
}

Result<void> checkReferences(const OctreeAsset& asset) {
    for (std::size_t i = 0; i < asset.instances.size(); ++i) {
        if (asset.instances[i].model >= asset.models.size()) {
            return fail(ErrorCode::BadReference,
                        fmt::format("instance {} places model {}, but there are {} models", i,
                                    asset.instances[i].model, asset.models.size()));
        }
    }
    for (const OctreeModel& model : asset.models) {
        for (const OctreeRegion& region : model.regions)
            PFVOX_CHECK(checkLod(region, asset.materials.size()));
    }
    return {};
}

/// MODL, REGN, TOPT or TOPN, and PALT: the tables that say where everything is.
struct ModelTables {
    std::vector<layout::Model> models;
    std::vector<layout::Region> regions;
    SectionContent topTrees;
    std::vector<std::uint16_t> palettes;
    std::vector<const OctreeRegion*> sources;  ///< of each region record

    ModelTables(const OctreeAsset& asset, Profile profile, NameTable& names)
        : topTrees(emptyTopTrees(profile)) {
        for (const OctreeModel& model : asset.models) {
            models.push_back(toLayout(model, static_cast<std::uint32_t>(regions.size()), names));
            if (!model.topTree.nodes.empty()) appendTopTree(model.topTree, profile, topTrees);
            for (const OctreeRegion& region : model.regions) {
                regions.push_back(toLayout(region, static_cast<std::uint32_t>(palettes.size())));
                palettes.insert(palettes.end(), region.palette.begin(), region.palette.end());
                sources.push_back(&region);
            }
        }
    }
};

void addInfoSections(const OctreeAsset& asset, NameTable& names, std::vector<SectionContent>& sections) {
    std::vector<layout::Material> materials;
    for (const Material& m : asset.materials) materials.push_back(toLayout(m, names));
    sections.push_back(recordSection("MATL", materials));

    std::vector<layout::Instance> instances;
    for (const Instance& i : asset.instances) instances.push_back(toLayout(i, names));
    sections.push_back(recordSection("INST", instances));

    std::vector<layout::Layer> layers;
    for (const Layer& l : asset.layers) {
        layers.push_back({.name = names.add(l.name), .flags = l.hidden ? layout::kLayerHidden : 0});
    }
    if (!layers.empty()) sections.push_back(recordSection("LAYR", layers));

    std::vector<layout::Camera> cameras;
    for (const Camera& c : asset.cameras) {
        const glm::vec3 p{c.position};
        const glm::vec3 t{c.target};
        cameras.push_back({.position = {p.x, p.y, p.z},
                           .target = {t.x, t.y, t.z},
                           .fovYDegrees = static_cast<float>(c.fovYDegrees),
                           .name = names.add(c.name)});
    }
    if (!cameras.empty()) sections.push_back(recordSection("CAMR", cameras));

    const layout::Meta meta{.voxelSizeMetres = asset.source.voxelSizeMetres,
                            .format = names.add(asset.source.format),
                            .noteCount = static_cast<std::uint32_t>(asset.source.notes.size())};
    SectionContent metaSection{.fourcc = "META", .count = 1, .raw = std::vector<std::uint8_t>(sizeof meta)};
    std::memcpy(metaSection.raw.data(), &meta, sizeof meta);
    for (const std::string& note : asset.source.notes) {
        const std::uint32_t index = names.add(note);
        const auto* bytes = reinterpret_cast<const std::uint8_t*>(&index);
        metaSection.raw.insert(metaSection.raw.end(), bytes, bytes + sizeof index);
    }
    sections.push_back(std::move(metaSection));
}

}  // namespace

Result<std::vector<std::byte>> encodePfVox(const OctreeAsset& asset, const EncodeSettings& settings) {
    PFVOX_CHECK(checkReferences(asset));
    NameTable names;
    ModelTables tables(asset, settings.profile, names);
    if (tables.regions.size() >= layout::kNoRegion / 2 || tables.palettes.size() > 0xffffffffu) {
        return fail(ErrorCode::LimitExceeded,
                    fmt::format("{} regions do not fit one file", tables.regions.size()));
    }
    std::vector<SectionContent> sections;
    addInfoSections(asset, names, sections);
    sections.push_back(recordSection("MODL", tables.models));
    sections.push_back(recordSection("REGN", tables.regions));
    if (!tables.topTrees.raw.empty()) sections.push_back(std::move(tables.topTrees));
    sections.push_back(recordSection("PALT", tables.palettes));
    sections.push_back(names.section());

    addRegionSections(tables.sources, asset.materials, settings.profile, sections);
    const FileTraits traits{.requiredFeatures = settings.profile == Profile::Resident ? kPfVoxResident : 0,
                            .optionalFeatures = asset.hollowed ? kPfVoxHollow : 0};
    return writeSections(std::move(sections), traits, settings);
}

}  // namespace pfvox
