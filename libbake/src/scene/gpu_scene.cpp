#include <chrono>
#include <pfvox/assert.hpp>
#include <pfvox/gpu_scene.hpp>

#include "scene/block_arena.hpp"
#include "scene/scene_records.hpp"
#include "scene/tree_block.hpp"

namespace pfvox::gpu {

namespace {

using namespace detail;

/// A model on its way to the device.
struct ModelLayout {
    std::vector<BlockLayout> regions;
    std::vector<BlockPlace> regionPlaces;
    BlockLayout topTree;
    BlockPlace topTreePlace;
    bool hasTopTree = false;
};

void count(const BlockLayout& layout, std::size_t nodes, SceneStatistics& statistics) {
    statistics.nodeBytes += 4 * nodes;
    statistics.lookupBytes += 4 * nodes;
    statistics.valueBytes += layout.valueBytes;
    statistics.otherBytes += layout.sizeBytes - 8 * nodes - layout.valueBytes;
}

Result<ModelLayout> layOut(const OctreeModel& model, BlockArena& arena, SceneStatistics& statistics) {
    ModelLayout layout;
    layout.hasTopTree = !model.topTree.nodes.empty();
    for (const OctreeRegion& region : model.regions) {
        layout.regions.push_back(layoutOfRegion(region));
        PFVOX_TRY(const BlockPlace, place, arena.add(layout.regions.back().sizeBytes));
        layout.regionPlaces.push_back(place);
        count(layout.regions.back(), region.tree.nodes.size(), statistics);
    }
    if (layout.hasTopTree) {
        layout.topTree = layoutOfTopTree(model);
        PFVOX_TRY(const BlockPlace, place, arena.add(layout.topTree.sizeBytes));
        layout.topTreePlace = place;
        count(layout.topTree, model.topTree.nodes.size(), statistics);
    }
    statistics.voxels += model.voxelCount;
    statistics.regions += static_cast<std::uint32_t>(model.regions.size());
    return layout;
}

/// Writes the blocks of one model and returns its record.
Result<shared::ModelRecord> uploadModel(Device& device, const UsedModel& used, const ModelLayout& layout,
                                        const BlockArena& arena) {
    std::vector<std::uint64_t> addresses;
    for (std::size_t i = 0; i < layout.regions.size(); ++i) {
        const BlockPlace place = layout.regionPlaces[i];
        const std::uint64_t sizeBytes = layout.regions[i].sizeBytes;
        PFVOX_TRY(const std::span<std::byte>, room,
                  device.stage(arena.buffer(place), place.offsetBytes, sizeBytes));
        writeRegion(used.model->regions[i], layout.regions[i], used.firstMaterial, room);
        addresses.push_back(arena.address(place));
    }
    shared::ModelRecord record = recordOf(*used.model);
    BlockPlace root = layout.regionPlaces[0];
    if (layout.hasTopTree) {
        root = layout.topTreePlace;
        PFVOX_TRY(const std::span<std::byte>, room,
                  device.stage(arena.buffer(root), root.offsetBytes, layout.topTree.sizeBytes));
        writeTopTree(*used.model, layout.topTree, addresses, room);
    }
    record.rootBlock = arena.buffer(root).addressWords(root.offsetBytes);
    return record;
}

template <class T>
std::uint64_t paddedBytes(const std::vector<T>& items) {
    return (items.size() * sizeof(T) + 63) / 64 * 64;
}

/// Header, BVH, instances, models and materials, one after the other in one buffer.
Result<Buffer> uploadTable(Device& device, const SceneRecords& records,
                           const std::vector<shared::ModelRecord>& models) {
    const std::uint64_t bvhAt = 64;
    const std::uint64_t instancesAt = bvhAt + paddedBytes(records.bvhNodes);
    const std::uint64_t modelsAt = instancesAt + paddedBytes(records.instances);
    const std::uint64_t materialsAt = modelsAt + paddedBytes(models);
    const std::uint64_t sizeBytes = materialsAt + paddedBytes(records.materials);
    PFVOX_TRY(Buffer, table, device.createBuffer(sizeBytes, "scene table"));

    const shared::SceneHeader header{.bvhNodes = table.addressWords(bvhAt),
                                     .instances = table.addressWords(instancesAt),
                                     .models = table.addressWords(modelsAt),
                                     .materials = table.addressWords(materialsAt),
                                     .instanceCount = static_cast<std::uint32_t>(records.instances.size()),
                                     .bvhNodeCount = static_cast<std::uint32_t>(records.bvhNodes.size()),
                                     .modelCount = static_cast<std::uint32_t>(models.size()),
                                     .materialCount = static_cast<std::uint32_t>(records.materials.size())};
    PFVOX_CHECK(device.upload(table, 0, bytesOf(header)));
    PFVOX_CHECK(device.upload(table, bvhAt, std::as_bytes(std::span(records.bvhNodes))));
    PFVOX_CHECK(device.upload(table, instancesAt, std::as_bytes(std::span(records.instances))));
    PFVOX_CHECK(device.upload(table, modelsAt, std::as_bytes(std::span(models))));
    PFVOX_CHECK(device.upload(table, materialsAt, std::as_bytes(std::span(records.materials))));
    return table;
}

}  // namespace

Result<Scene> Scene::build(Device& device, std::span<const ScenePart> parts, Diagnostics& diagnostics) {
    const auto started = std::chrono::steady_clock::now();
    PFVOX_TRY(const SceneRecords, records, makeRecords(parts, diagnostics));

    SceneStatistics statistics;
    BlockArena arena(device.maxBufferBytes());
    std::vector<ModelLayout> layouts;
    for (const UsedModel& used : records.models) {
        PFVOX_TRY(ModelLayout, layout, layOut(*used.model, arena, statistics));
        layouts.push_back(std::move(layout));
    }
    PFVOX_CHECK(arena.createBuffers(device));
    std::vector<shared::ModelRecord> models;
    for (std::size_t i = 0; i < layouts.size(); ++i) {
        PFVOX_TRY(const shared::ModelRecord, record,
                  uploadModel(device, records.models[i], layouts[i], arena));
        models.push_back(record);
    }
    PFVOX_TRY(Buffer, table, uploadTable(device, records, models));
    PFVOX_CHECK(device.flush());

    statistics.models = static_cast<std::uint32_t>(models.size());
    statistics.instances = static_cast<std::uint32_t>(records.instances.size());
    statistics.materials = static_cast<std::uint32_t>(records.materials.size());
    statistics.bvhNodes = static_cast<std::uint32_t>(records.bvhNodes.size());
    statistics.instanceBytes = table.sizeBytes();
    const std::chrono::duration<double, std::milli> elapsed = std::chrono::steady_clock::now() - started;
    statistics.buildMs = elapsed.count();

    Scene scene(std::move(table), arena.takeBuffers());
    scene.bounds_ = records.bounds;
    scene.statistics_ = statistics;
    return scene;
}

}  // namespace pfvox::gpu
