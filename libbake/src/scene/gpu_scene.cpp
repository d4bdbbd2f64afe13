#include <algorithm>
#include <chrono>
#include <map>
#include <numeric>
#include <pfvox/gpu_scene.hpp>

#include "scene/face_table.hpp"
#include "scene/scene_records.hpp"
#include "scene/wide_tree.hpp"

namespace pfvox::gpu {

namespace {

using namespace detail;

struct BlockPlace {
    std::size_t buffer = 0;
    std::uint64_t offsetBytes = 0;
};

/// Places many tree blocks in few buffers: a driver allows some thousand allocations, a scene may have more
/// regions. Blocks are added first, then all buffers are made at once, as large as needed.
class BlockArena {
  public:
    explicit BlockArena(std::uint64_t maxBufferBytes) : maxBufferBytes_(maxBufferBytes) {}

    /// Errors: GpuOutOfMemory when one block is larger than a buffer can be.
    Result<BlockPlace> add(std::uint64_t sizeBytes) {
        constexpr std::uint64_t kUsualBufferBytes = 512u << 20;
        if (sizeBytes > maxBufferBytes_) {
            return fail(ErrorCode::GpuOutOfMemory,
                        "an octree block of " + std::to_string(sizeBytes) +
                            " bytes is larger than a buffer of this device can be");
        }
        const std::uint64_t limit = std::min(kUsualBufferBytes, maxBufferBytes_);
        if (sizes_.empty() || sizes_.back() + sizeBytes > limit) sizes_.push_back(0);
        const BlockPlace place{.buffer = sizes_.size() - 1, .offsetBytes = sizes_.back()};
        sizes_.back() += sizeBytes;
        return place;
    }
    Result<void> createBuffers(Device& device) {
        for (std::size_t i = 0; i < sizes_.size(); ++i) {
            PFVOX_TRY(Buffer, made, device.createBuffer(sizes_[i], "tree blocks " + std::to_string(i)));
            buffers_.push_back(std::move(made));
        }
        return {};
    }

    const Buffer& buffer(BlockPlace place) const { return buffers_[place.buffer]; }
    std::uint64_t address(BlockPlace place) const { return buffer(place).address() + place.offsetBytes; }
    std::vector<Buffer> takeBuffers() { return std::move(buffers_); }

  private:
    std::uint64_t maxBufferBytes_;
    std::vector<std::uint64_t> sizes_;
    std::vector<Buffer> buffers_;
};

/// A model on its way to the device, and where its arrays lie in its block.
struct WideModel {
    std::size_t index = 0;  ///< in SceneRecords::models
    WideTree tree;
    BlockPlace place;
    std::uint64_t lodsAt = 0;
    std::uint64_t valuesAt = 0;
    std::uint64_t palettesAt = 0;
    std::shared_ptr<const FaceTable> faces{};
    std::uint64_t faceCellsAt = 0;
    std::uint64_t faceSlotsAt = 0;
};

constexpr std::uint64_t padded(std::uint64_t sizeBytes) {
    return (sizeBytes + 63) / 64 * 64;
}

Result<WideModel> layOut(std::size_t index, const UsedModel& used, bool withFaces, BlockArena& arena) {
    PFVOX_TRY(WideTree, tree, widen(*used.model, used.firstMaterial));
    WideModel model{.index = index, .tree = std::move(tree), .place = {}};
    if (withFaces) {
        PFVOX_TRY(FaceIndex, faces, makeFaceIndex(*used.model, *used.materials));
        PFVOX_TRY(FaceTable, table, makeFaceTable(*used.model, model.tree, std::move(faces)));
        model.faces = std::make_shared<const FaceTable>(std::move(table));
    }
    model.lodsAt = padded(model.tree.nodeBytes());
    model.valuesAt = model.lodsAt + padded(model.tree.lodBytes());
    model.palettesAt = model.valuesAt + padded(model.tree.valueBytes());
    model.faceCellsAt = model.palettesAt + padded(model.tree.paletteBytes());
    model.faceSlotsAt =
        model.faceCellsAt + (model.faces ? padded(sizeof(glm::uvec2) * model.faces->cells.size()) : 0);
    const std::uint64_t end =
        model.faceSlotsAt + (model.faces ? padded(sizeof(glm::uvec2) * model.faces->slots.size()) : 0);
    PFVOX_TRY(const BlockPlace, place, arena.add(end));
    model.place = place;
    return model;
}

/// Writes a model's arrays and returns its record.
Result<shared::ModelRecord> uploadModel(Device& device, const UsedModel& used, const WideModel& model,
                                        const BlockArena& arena) {
    const Buffer& buffer = arena.buffer(model.place);
    const std::uint64_t start = model.place.offsetBytes;
    const auto put = [&](const auto& items, std::uint64_t at) -> Result<void> {
        if (items.empty()) return {};
        return device.upload(buffer, start + at, std::as_bytes(std::span(items)));
    };
    for (std::size_t i = 0; i < model.tree.pieces.size(); ++i) {
        const WidePiece& piece = model.tree.pieces[i];
        const WidePlace& at = model.tree.places[i];
        PFVOX_CHECK(put(piece.nodes, sizeof(shared::WideNode) * at.firstNode));
        PFVOX_CHECK(put(piece.lods, model.lodsAt + sizeof(glm::uvec2) * at.firstNode));
        PFVOX_CHECK(put(piece.values, model.valuesAt + at.firstValueByte));
        PFVOX_CHECK(put(piece.palette, model.palettesAt + 4 * at.firstPaletteEntry));
    }
    shared::ModelRecord record = recordOf(*used.model);
    record.nodes = buffer.addressWords(start);
    if (model.tree.hasLods) record.lods = buffer.addressWords(start + model.lodsAt);
    record.values = buffer.addressWords(start + model.valuesAt);
    record.palettes = buffer.addressWords(start + model.palettesAt);
    if (model.faces) {
        PFVOX_CHECK(put(model.faces->cells, model.faceCellsAt));
        PFVOX_CHECK(put(model.faces->slots, model.faceSlotsAt));
        record.faceCells = buffer.addressWords(start + model.faceCellsAt);
        record.faceSlots = buffer.addressWords(start + model.faceSlotsAt);
    }
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

std::vector<ScenePart> partsOf(const LoadedScene& scene) {
    std::vector<ScenePart> parts;
    for (const PlacedAsset& part : scene.parts) {
        parts.push_back({.asset = part.asset.get(), .worldFromAsset = part.worldFromAsset});
    }
    return parts;
}

/// A model on the device. The buffer holds other models too.
struct Scene::PlacedModel {
    UsedModel used;
    shared::ModelRecord record;
    std::shared_ptr<const FaceTable> faces;  ///< nothing unless asked for
    std::uint64_t nodeBytes = 0;
    std::uint64_t lodBytes = 0;
    std::uint64_t valueBytes = 0;
    std::uint64_t paletteBytes = 0;
    std::shared_ptr<const Buffer> block;
};

/// Brings models to the device, or takes those that are there.
class Scene::ModelPlacer {
  public:
    ModelPlacer(Device& device, const SceneOptions& options)
        : device_(device), faces_(options.faces), arena_(device.maxBufferBytes()) {
        if (options.known == nullptr) return;
        for (const auto& model : options.known->models_)
            if (!faces_ || model->faces) known_[keyOf(model->used)] = model;
    }

    Result<PlacedModels> place(const std::vector<UsedModel>& wanted) {
        placed_.resize(wanted.size());
        std::vector<WideModel> fresh;
        for (std::size_t i = 0; i < wanted.size(); ++i) {
            const auto found = known_.find(keyOf(wanted[i]));
            if (found != known_.end()) {
                placed_[i] = found->second;
                continue;
            }
            PFVOX_TRY(WideModel, model, layOut(i, wanted[i], faces_, arena_));
            fresh.push_back(std::move(model));
        }
        PFVOX_CHECK(arena_.createBuffers(device_));
        for (const WideModel& model : fresh) PFVOX_CHECK(upload(wanted[model.index], model));
        share(fresh);
        return PlacedModels(placed_.begin(), placed_.end());
    }

  private:
    using Key = std::pair<const OctreeModel*, std::uint32_t>;
    static Key keyOf(const UsedModel& used) { return {used.model, used.firstMaterial}; }

    Result<void> upload(const UsedModel& used, const WideModel& model) {
        PFVOX_TRY(const shared::ModelRecord, record, uploadModel(device_, used, model, arena_));
        fresh_[model.index] =
            std::make_shared<PlacedModel>(PlacedModel{.used = used,
                                                      .record = record,
                                                      .faces = model.faces,
                                                      .nodeBytes = model.tree.nodeBytes(),
                                                      .lodBytes = model.tree.lodBytes(),
                                                      .valueBytes = model.tree.valueBytes(),
                                                      .paletteBytes = model.tree.paletteBytes(),
                                                      .block = nullptr});
        return {};
    }

    /// Each buffer lives as long as one of its models does.
    void share(const std::vector<WideModel>& fresh) {
        std::vector<std::shared_ptr<const Buffer>> blocks;
        for (Buffer& buffer : arena_.takeBuffers())
            blocks.push_back(std::make_shared<const Buffer>(std::move(buffer)));
        for (const WideModel& model : fresh) {
            fresh_[model.index]->block = blocks[model.place.buffer];
            placed_[model.index] = fresh_[model.index];
        }
    }

    Device& device_;
    bool faces_;
    BlockArena arena_;
    std::map<Key, std::shared_ptr<const PlacedModel>> known_;
    std::map<std::size_t, std::shared_ptr<PlacedModel>> fresh_;
    std::vector<std::shared_ptr<const PlacedModel>> placed_;
};

/// Gives the faces of each instance their place in the list of all, in the order of instances. How many there
/// are, or means if these are more.
std::uint64_t Scene::numberFaces(SceneRecords& records, const PlacedModels& placed,
                                 std::vector<PlacedFaces>& faces) {
    std::vector<std::size_t> order(records.instances.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::sort(order, {}, [&](std::size_t i) { return records.instances[i].id; });
    std::uint64_t next = 0;
    std::uint64_t nextMean = 0;
    for (const std::size_t i : order) {
        shared::InstanceRecord& record = records.instances[i];
        const PlacedModel& model = *placed[record.model];
        record.firstFace = static_cast<std::uint32_t>(next);
        record.firstMean = static_cast<std::uint32_t>(nextMean);
        faces.push_back({.instance = static_cast<std::uint32_t>(i),
                         .firstFace = record.firstFace,
                         .firstMean = record.firstMean,
                         .model = model.used.model,
                         .index = &model.faces->index,
                         .frameFromModel = records.frameFromModel[i],
                         .table = model.faces});
        next += model.faces->index.faceCount;
        nextMean += model.faces->slots.size();
    }
    return std::max(next, nextMean);
}

Result<Scene> Scene::build(Device& device, std::span<const ScenePart> parts, Diagnostics& diagnostics,
                           const SceneOptions& options) {
    const auto started = std::chrono::steady_clock::now();
    PFVOX_TRY(SceneRecords, records, makeRecords(parts, options.origin, diagnostics));
    PFVOX_TRY(PlacedModels, placed, ModelPlacer(device, options).place(records.models));
    std::vector<shared::ModelRecord> models;
    SceneStatistics statistics;
    for (const auto& model : placed) {
        models.push_back(model->record);
        statistics.voxels += model->used.model->voxelCount;
        statistics.regions += static_cast<std::uint32_t>(model->used.model->regions.size());
        statistics.nodeBytes += model->nodeBytes;
        statistics.lodBytes += model->lodBytes;
        statistics.valueBytes += model->valueBytes;
        statistics.paletteBytes += model->paletteBytes;
        if (model->faces)
            statistics.faceBytes +=
                sizeof(glm::uvec2) * (model->faces->cells.size() + model->faces->slots.size());
    }
    std::vector<PlacedFaces> faces;
    if (options.faces) {
        const std::uint64_t faceCount = numberFaces(records, placed, faces);
        if (faceCount > 0xffffffffu)
            return fail(ErrorCode::GpuOutOfMemory, "the scene has " + std::to_string(faceCount) +
                                                       " faces; light is baked for at most 4 billion");
    }
    PFVOX_TRY(Buffer, table, uploadTable(device, records, models));
    PFVOX_CHECK(device.flush());

    statistics.models = static_cast<std::uint32_t>(models.size());
    statistics.instances = static_cast<std::uint32_t>(records.instances.size());
    statistics.materials = static_cast<std::uint32_t>(records.materials.size());
    statistics.hasGlass = records.hasGlass;
    statistics.hasMirrors = records.hasMirrors;
    statistics.bvhNodes = static_cast<std::uint32_t>(records.bvhNodes.size());
    statistics.instanceBytes = table.sizeBytes();
    const std::chrono::duration<double, std::milli> elapsed = std::chrono::steady_clock::now() - started;
    statistics.buildMs = elapsed.count();

    Scene scene(std::move(table), std::move(placed));
    scene.bounds_ = records.bounds;
    scene.origin_ = options.origin;
    scene.faces_ = std::move(faces);
    for (const PlacedFaces& placedFaces : scene.faces_) scene.faceCount_ += placedFaces.index->faceCount;
    scene.statistics_ = statistics;
    return scene;
}

}  // namespace pfvox::gpu
