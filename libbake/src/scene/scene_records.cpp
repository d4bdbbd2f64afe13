#include "scene/scene_records.hpp"

#include <fmt/format.h>
#include <array>
#include <cmath>
#include <unordered_map>

#include "scene/wide_tree.hpp"
#include "shared/color.glsl.h"

namespace pfvox::gpu::detail {

namespace {

shared::MaterialRecord recordOf(const Material& material) {
    const glm::u8vec4 c = material.baseColor;
    return {.albedo = glm::vec3(shared::linearFromSrgb(glm::dvec3(c) / 255.0)),
            .emissionStrength = material.emissionStrength,
            .type = static_cast<std::uint32_t>(material.type),
            .metalness = material.metalness,
            .roughness = material.roughness,
            .specular = material.specular,
            .indexOfRefraction = material.indexOfRefraction,
            .transparency = material.transparency,
            .alpha = static_cast<float>(c.a) / 255.0f,
            .reserved0 = 0};
}

bool mirrors(const Material& m) {
    const bool metal = m.type == MaterialType::Metal && m.metalness > 0.0f;
    return (metal || m.type == MaterialType::Plastic) && m.emissionStrength == 0.0f;
}

/// Cube space of a model: what its wide root spans is [1, 2)^3.
Affine voxelsFromCube(const OctreeModel& model) {
    const double edge = std::ldexp(1.0, 2 * static_cast<int>(wideLevels(model.depth)));
    Affine m{edge};
    m[3] = glm::dvec3(model.originVoxels) - edge;
    return m;
}

/// Corners are transformed in double and rounded away from the box.
Box boxOf(const VoxelBox& voxels, const Affine& worldFromModel, const glm::dvec3& origin, WorldBox& exact) {
    WorldBox box;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 p((corner & 1) != 0 ? voxels.max.x : voxels.min.x,
                           (corner & 2) != 0 ? voxels.max.y : voxels.min.y,
                           (corner & 4) != 0 ? voxels.max.z : voxels.min.z);
        const glm::dvec3 world = worldFromModel * glm::dvec4(p, 1.0);
        box.min = glm::min(box.min, world);
        box.max = glm::max(box.max, world);
    }
    exact.min = glm::min(exact.min, box.min);
    exact.max = glm::max(exact.max, box.max);
    Box rounded;
    for (int axis = 0; axis < 3; ++axis) {
        const double low = box.min[axis] - origin[axis];
        const double high = box.max[axis] - origin[axis];
        const double slack = 1e-6 * (std::abs(low) + std::abs(high));
        rounded.min[axis] = static_cast<float>(low - slack);
        rounded.max[axis] = static_cast<float>(high + slack);
    }
    return rounded;
}

class RecordMaker {
  public:
    RecordMaker(SceneRecords& records, const glm::dvec3& origin, Diagnostics& diagnostics)
        : records_(records), origin_(origin), diagnostics_(diagnostics) {}

    Result<void> add(const ScenePart& part) {
        const OctreeAsset& asset = *part.asset;
        const std::uint32_t firstMaterial = firstMaterialOf(asset);
        for (const pfvox::Instance& instance : asset.instances) {
            const std::uint32_t id = nextId_++;
            if (instance.model >= asset.models.size()) {
                return fail(ErrorCode::BadReference,
                            fmt::format("instance '{}' is of model {}, but there are {} models",
                                        instance.name, instance.model, asset.models.size()));
            }
            const OctreeModel& model = asset.models[instance.model];
            if (isHidden(asset, instance) || model.regions.empty()) continue;
            if (model.depth > 2 * shared::kMaxWideLevels) {
                return fail(ErrorCode::UnsupportedFeature,
                            fmt::format("model '{}' has {} octree levels; the GPU traversal has {}",
                                        model.name, model.depth, 2 * shared::kMaxWideLevels));
            }
            addInstance(instance, part.worldFromAsset, {&model, &asset.materials, firstMaterial}, id);
        }
        return {};
    }

    void finish() {
        Bvh bvh = buildBvh(boxes_);
        records_.bvhNodes = std::move(bvh.nodes);
        for (const std::uint32_t i : bvh.order) {
            records_.instances.push_back(unordered_[i]);
            records_.frameFromModel.push_back(frames_[i]);
        }
    }

  private:
    /// An asset that stands in several places has its materials once.
    std::uint32_t firstMaterialOf(const OctreeAsset& asset) {
        const auto next = static_cast<std::uint32_t>(records_.materials.size());
        const auto [entry, added] = firstMaterialOf_.try_emplace(&asset, next);
        if (added) {
            for (const Material& material : asset.materials) {
                records_.materials.push_back(recordOf(material));
                records_.hasGlass |= letsThrough(material);
                records_.hasMirrors |= mirrors(material);
            }
        }
        return entry->second;
    }

    void addInstance(const pfvox::Instance& instance, const Affine& worldFromAsset, UsedModel used,
                     std::uint32_t id) {
        const Affine worldFromModel = compose(worldFromAsset, instance.worldFromModel);
        Affine frameFromCube = compose(worldFromModel, voxelsFromCube(*used.model));
        frameFromCube[3] -= origin_;
        const glm::dmat4 cubeFromWorld = glm::inverse(glm::dmat4(frameFromCube));
        bool finite = true;
        for (int column = 0; column < 4; ++column) {
            for (int row = 0; row < 3; ++row) finite &= std::abs(cubeFromWorld[column][row]) < 1e30;
        }
        if (!finite) {
            diagnostics_.warn(
                "scene-flat-instance",
                fmt::format("instance '{}' is left out: its transform cannot be inverted", instance.name));
            return;
        }
        const auto row = [&](int r) {
            return glm::vec4(cubeFromWorld[0][r], cubeFromWorld[1][r], cubeFromWorld[2][r],
                             cubeFromWorld[3][r]);
        };
        unordered_.push_back({.cubeFromWorld0 = row(0),
                              .cubeFromWorld1 = row(1),
                              .cubeFromWorld2 = row(2),
                              .model = modelIndex(used),
                              .id = id,
                              .firstFace = 0,
                              .firstMean = 0});
        Affine frameFromModel = worldFromModel;
        frameFromModel[3] -= origin_;
        frames_.push_back(frameFromModel);
        boxes_.push_back(boxOf(used.model->bounds, worldFromModel, origin_, records_.bounds));
    }

    std::uint32_t modelIndex(UsedModel used) {
        const auto next = static_cast<std::uint32_t>(records_.models.size());
        const auto [entry, added] = indexOf_.try_emplace(used.model, next);
        if (added) records_.models.push_back(used);
        return entry->second;
    }

    SceneRecords& records_;
    glm::dvec3 origin_;
    Diagnostics& diagnostics_;
    std::unordered_map<const OctreeModel*, std::uint32_t> indexOf_;
    std::unordered_map<const OctreeAsset*, std::uint32_t> firstMaterialOf_;
    std::vector<shared::InstanceRecord> unordered_;
    std::vector<Affine> frames_;
    std::vector<Box> boxes_;
    std::uint32_t nextId_ = 0;
};

}  // namespace

Result<SceneRecords> makeRecords(std::span<const ScenePart> parts, const glm::dvec3& origin,
                                 Diagnostics& diagnostics) {
    SceneRecords records;
    RecordMaker maker(records, origin, diagnostics);
    for (const ScenePart& part : parts) PFVOX_CHECK(maker.add(part));
    maker.finish();
    return records;
}

shared::ModelRecord recordOf(const OctreeModel& model) {
    // Corners of the box are whole voxels: exact in float for every depth that the traversal allows.
    const std::uint32_t cubeLog2 = 2 * wideLevels(model.depth);
    const double voxel = std::ldexp(1.0, -static_cast<int>(cubeLog2));
    const auto cubeFromVoxel = [&](glm::ivec3 corner) {
        return glm::vec3(1.0 + glm::dvec3(glm::i64vec3(corner) - glm::i64vec3(model.originVoxels)) * voxel);
    };
    return {.boxMin = cubeFromVoxel(model.bounds.min),
            .leafScale = 23 - cubeLog2,
            .boxMax = cubeFromVoxel(model.bounds.max),
            .reserved0 = 0,
            .nodes = {0, 0},
            .values = {0, 0},
            .palettes = {0, 0},
            .lods = {0, 0},
            .originVoxels = model.originVoxels,
            .reserved1 = 0,
            .faceCells = {0, 0},
            .faceSlots = {0, 0}};
}

}  // namespace pfvox::gpu::detail
