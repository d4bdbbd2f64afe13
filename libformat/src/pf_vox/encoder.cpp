// encodePfVox: an OctreeAsset as sections. What can be computed from the masks is not written
// (node_planes.hpp).
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <pfvox/pf_vox.hpp>

#include "guarded.hpp"
#include "octree/node_planes.hpp"
#include "pf_vox/names.hpp"
#include "pf_vox/record_rules.hpp"
#include "pf_vox/region_writer.hpp"

namespace pfvox {

namespace {

using container::recordSection;
using container::SectionContent;

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

/// Whether a float of its own moves the instance too far.
bool needsExactPlace(const Affine& m) {
    const double voxel = std::min({glm::length(m[0]), glm::length(m[1]), glm::length(m[2])});
    const glm::dvec3 rounded{glm::vec3{m[3]}};
    return glm::any(glm::greaterThan(glm::abs(m[3] - rounded), glm::dvec3(layout::kPlaceSlack * voxel)));
}

layout::Camera toLayout(const Camera& camera, NameTable& names) {
    const glm::vec3 p{camera.position};
    const glm::vec3 t{camera.target};
    return {.position = {p.x, p.y, p.z},
            .target = {t.x, t.y, t.z},
            .fovYDegrees = static_cast<float>(camera.fovYDegrees),
            .name = names.add(camera.name)};
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

Result<void> checkLods(const OctreeAsset& asset) {
    for (const OctreeModel& model : asset.models) {
        for (const OctreeRegion& region : model.regions)
            PFVOX_CHECK(checkLod(region, asset.materials.size()));
    }
    return {};
}

/// MODL, REGN, TOPT or TOPN, and PALT: the tables that say where everything is.
struct ModelRecords {
    std::vector<layout::Model> models;
    std::vector<layout::Region> regions;
    SectionContent topTrees;
    std::vector<std::uint16_t> palettes;
    std::vector<const OctreeRegion*> sources;  ///< of each region record

    ModelRecords(const OctreeAsset& asset, Profile profile, NameTable& names)
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

/// MATL, INST, INSX, LAYR, CAMR and META.
struct InfoRecords {
    std::vector<layout::Material> materials;
    std::vector<layout::Instance> instances;
    std::vector<layout::Place> places;
    std::vector<layout::Layer> layers;
    std::vector<layout::Camera> cameras;
    layout::Meta meta{};
    std::vector<std::uint32_t> notes;

    InfoRecords(const OctreeAsset& asset, NameTable& names) {
        for (const Material& m : asset.materials) materials.push_back(toLayout(m, names));
        bool isFar = false;
        for (const Instance& i : asset.instances) {
            instances.push_back(toLayout(i, names));
            places.push_back({{i.worldFromModel[3].x, i.worldFromModel[3].y, i.worldFromModel[3].z}});
            isFar = isFar || needsExactPlace(i.worldFromModel);
        }
        if (!isFar) places.clear();
        for (const Layer& l : asset.layers)
            layers.push_back({.name = names.add(l.name), .flags = l.hidden ? layout::kLayerHidden : 0});
        for (const Camera& c : asset.cameras) cameras.push_back(toLayout(c, names));
        meta = {.voxelSizeMetres = asset.source.voxelSizeMetres,
                .format = names.add(asset.source.format),
                .noteCount = static_cast<std::uint32_t>(asset.source.notes.size())};
        for (const Name& note : asset.source.notes) notes.push_back(names.add(note));
    }

    void addTo(std::vector<SectionContent>& sections) const {
        sections.push_back(recordSection("MATL", materials));
        sections.push_back(recordSection("INST", instances));
        if (!places.empty()) {
            sections.push_back(recordSection("INSX", places));
            sections.back().mustUnderstand = false;
        }
        if (!layers.empty()) sections.push_back(recordSection("LAYR", layers));
        if (!cameras.empty()) sections.push_back(recordSection("CAMR", cameras));
        sections.push_back(recordSection("META", std::vector{meta}));
        container::appendBytes(sections.back().raw, std::span(notes));
    }
};

/// What the reader would refuse is not written.
Result<void> checkRecords(const InfoRecords& info, const ModelRecords& models) {
    Result<void> result;
    const FaultSink stop = [&](std::string_view, Error fault) {
        result = tl::make_unexpected(std::move(fault));
        return false;
    };
    constexpr Limits kNone{.maxRegions = ~0u, .maxModelDepth = ~0u};
    const bool isSound =
        checkInfo({.materials = info.materials,
                   .instances = info.instances,
                   .places = info.places,
                   .layerCount = info.layers.size(),
                   .cameras = info.cameras,
                   .meta = info.meta},
                  stop) &&
        checkPlacements(info.instances, models.models.size(), stop) &&
        checkModels({models.models, models.regions, models.palettes}, info.materials.size(), kNone, stop);
    if (!isSound && result) return fail(ErrorCode::Internal, "records are refused without a reason");
    return result;
}

Result<std::vector<std::byte>> encode(const OctreeAsset& asset, const EncodeSettings& settings) {
    PFVOX_CHECK(checkLods(asset));
    NameTable names;
    ModelRecords models(asset, settings.profile, names);
    const InfoRecords info(asset, names);
    if (models.regions.size() >= layout::kNoRegion / 2 || models.palettes.size() > 0xffffffffu) {
        return fail(ErrorCode::LimitExceeded,
                    fmt::format("{} regions do not fit one file", models.regions.size()));
    }
    PFVOX_CHECK(checkRecords(info, models));
    std::vector<SectionContent> sections;
    info.addTo(sections);
    sections.push_back(recordSection("MODL", models.models));
    sections.push_back(recordSection("REGN", models.regions));
    if (!models.topTrees.raw.empty()) sections.push_back(std::move(models.topTrees));
    sections.push_back(recordSection("PALT", models.palettes));
    PFVOX_TRY(auto, nameSection, names.section());
    sections.push_back(std::move(nameSection));
    addRegionSections(models.sources, asset.materials, settings.profile, sections);
    return container::writeSections(
        std::move(sections), {.format = container::kPfVox,
                              .versionMinor = info.places.empty() ? std::uint16_t{0} : kPfVoxVersionMinor,
                              .requiredFeatures = settings.profile == Profile::Resident ? kPfVoxResident : 0,
                              .optionalFeatures = asset.hollowed ? kPfVoxHollow : 0,
                              .contentKey = settings.contentKey,
                              .zstdLevel = settings.zstdLevel});
}

}  // namespace

Result<std::vector<std::byte>> encodePfVox(const OctreeAsset& asset, const EncodeSettings& settings) {
    return guarded([&] { return encode(asset, settings); });
}

}  // namespace pfvox
