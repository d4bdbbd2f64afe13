// Models for tests: small, seeded, each with a feature of its own.
#pragma once

#include <cstdint>
#include <pfvox/octree.hpp>
#include <pfvox/voxel_model.hpp>
#include <random>
#include <string>
#include <vector>

namespace pfvox::test {

struct NamedModel {
    std::string name;
    VoxelModel model;
};

inline VoxelModel randomModel(std::uint32_t seed, glm::ivec3 min, glm::ivec3 max, double fill,
                              int materials) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> chance(0.0, 1.0);
    std::uniform_int_distribution<int> material(0, materials - 1);
    VoxelModel model;
    for (int z = min.z; z < max.z; ++z)
        for (int y = min.y; y < max.y; ++y)
            for (int x = min.x; x < max.x; ++x)
                if (chance(random) < fill) model.set({x, y, z}, static_cast<MaterialIndex>(material(random)));
    return model;
}

/// Solid box of one material.
inline VoxelModel boxModel(glm::ivec3 min, glm::ivec3 max, MaterialIndex material) {
    VoxelModel model;
    for (int z = min.z; z < max.z; ++z)
        for (int y = min.y; y < max.y; ++y)
            for (int x = min.x; x < max.x; ++x) model.set({x, y, z}, material);
    return model;
}

/// Boxes and noise over each other: merges at several levels next to single voxels, materials in patches.
inline VoxelModel patchyModel(std::uint32_t seed, int edge) {
    std::mt19937 random(seed);
    std::uniform_int_distribution<int> at(0, edge - 1);
    std::uniform_int_distribution<int> size(1, std::max(1, edge / 3));
    std::uniform_int_distribution<int> material(0, 3);
    VoxelModel model;
    for (int i = 0; i < 12; ++i) {
        const glm::ivec3 a{at(random), at(random), at(random)};
        const glm::ivec3 b = glm::min(a + size(random), glm::ivec3{edge});
        const auto m = static_cast<MaterialIndex>(material(random));
        for (int z = a.z; z < b.z; ++z)
            for (int y = a.y; y < b.y; ++y)
                for (int x = a.x; x < b.x; ++x) model.set({x, y, z}, m);
    }
    return model;
}

/// Every case that the round trip must survive.
inline std::vector<NamedModel> standardModels() {
    std::vector<NamedModel> models;
    const auto add = [&](std::string name, VoxelModel model) {
        models.push_back({std::move(name), std::move(model)});
    };
    add("empty", {});
    add("single voxel", boxModel({0, 0, 0}, {1, 1, 1}, 3));
    add("single voxel in a corner", boxModel({255, 255, 255}, {256, 256, 256}, 1));
    add("two cubed, one material", boxModel({0, 0, 0}, {2, 2, 2}, 0));
    add("sixteen cubed, one material", boxModel({0, 0, 0}, {16, 16, 16}, 2));
    add("box at odd place", boxModel({3, 5, 7}, {20, 9, 31}, 1));
    add("dense noise", randomModel(1, {0, 0, 0}, {24, 24, 24}, 1.0, 4));
    add("half noise", randomModel(2, {0, 0, 0}, {33, 17, 9}, 0.5, 4));
    add("sparse noise", randomModel(3, {0, 0, 0}, {64, 64, 64}, 0.01, 4));
    add("negative coordinates", randomModel(4, {-20, -9, -3}, {14, 7, 11}, 0.4, 4));
    {
        // A whole region, 256^3: solid, with one voxel of another material and one missing.
        VoxelModel whole;
        whole.fillTile({0, 0, 0}, 8, 1);
        whole.set({77, 200, 3}, 2);
        whole.clear({255, 0, 128});
        add("whole region", std::move(whole));
    }
    add("across a region border", boxModel({250, 2, 3}, {262, 8, 9}, 1));
    for (std::uint32_t seed = 0; seed < 6; ++seed) {
        add("patches " + std::to_string(seed), patchyModel(100 + seed, 20 + 13 * static_cast<int>(seed)));
    }
    {
        VoxelModel far;
        far.set({0, 0, 0}, 0);
        far.set({100000, 3, 70000}, 1);
        far.set({-5000, 40000, -1}, 2);
        add("far apart", std::move(far));
    }
    {
        VoxelModel tiles = randomModel(9, {-4, -4, -4}, {12, 12, 12}, 0.7, 4);
        tiles.fillTile({512, 0, 0}, 8, 2);
        tiles.fillTile({768, 256, 0}, 7, 3);
        tiles.fillTile({0, 64, 0}, 6, 1);
        tiles.set({520, 1, 1}, 0);
        tiles.clear({530, 2, 2});
        add("tiles", std::move(tiles));
    }
    return models;
}

/// An asset around models, with four materials of every kind of content and one instance a model.
inline VoxelAsset assetOf(std::vector<VoxelModel> models) {
    VoxelAsset asset;
    asset.materials = {
        {.baseColor = {200, 40, 30, 255}, .name = "brick"},
        {.baseColor = {30, 180, 50, 255},
         .type = MaterialType::Metal,
         .metalness = 0.75f,
         .roughness = 0.25f},
        {.baseColor = {250, 240, 200, 255},
         .type = MaterialType::Emit,
         .emissionStrength = 12.5f,
         .name = "lamp"},
        {.baseColor = {120, 160, 255, 90},
         .type = MaterialType::Glass,
         .indexOfRefraction = 1.33f,
         .transparency = 0.8f},
    };
    asset.layers = {{.name = "ground", .hidden = false}, {.name = "draft", .hidden = true}};
    asset.cameras = {{.name = "front", .position = {1, 2, 3}, .target = {0, 0, 0}, .fovYDegrees = 50}};
    asset.source = {.format = "test", .voxelSizeMetres = 0.125, .notes = {"made by a test"}};
    for (std::uint32_t i = 0; i < models.size(); ++i) {
        Affine worldFromModel = identityAffine();
        worldFromModel[3] = {0.5 * i, 1.0, -2.0};
        asset.instances.push_back({.model = i,
                                   .worldFromModel = worldFromModel,
                                   .name = "instance",
                                   .layer = 0,
                                   .hidden = i % 2 == 1});
    }
    asset.models = std::move(models);
    return asset;
}

/// Every voxel of a sparse grid, as a list that can be compared.
struct Voxel {
    glm::ivec3 position;
    MaterialIndex material;
    bool operator==(const Voxel&) const = default;
};
inline std::vector<Voxel> voxelsIn(const VoxelModel& model, const VoxelBox& box) {
    std::vector<Voxel> voxels;
    for (int z = box.min.z; z < box.max.z; ++z)
        for (int y = box.min.y; y < box.max.y; ++y)
            for (int x = box.min.x; x < box.max.x; ++x)
                if (const auto m = model.at({x, y, z})) voxels.push_back({{x, y, z}, *m});
    return voxels;
}

/// The same voxels, one by one: VoxelModel itself cannot be copied.
inline VoxelModel copyOf(const VoxelModel& model, const VoxelBox& box) {
    VoxelModel copy;
    for (const Voxel& v : voxelsIn(model, box)) copy.set(v.position, v.material);
    return copy;
}

}  // namespace pfvox::test
