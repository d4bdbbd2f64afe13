// Level of detail: every node's color, coverage and material against an oracle that asks for every voxel of
// its cube.
#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <pfvox/octree.hpp>
#include <pfvox/pf_vox.hpp>
#include <set>

#include "shared/color.glsl.h"
#include "support/voxel_models.hpp"

namespace pfvox {
namespace {

constexpr glm::ivec3 kSteps[6] = {{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}};

OctreeAsset buildWithLod(const VoxelAsset& asset) {
    return buildOctrees(asset, Limits{}, {.lod = true}).value();
}

double linearOf(std::uint8_t srgb) {
    return shared::linearFromSrgb(srgb / 255.0);
}

double srgbOf(double linear) {
    return 255.0 * shared::srgbFromLinear(linear);
}

/// What a node should be, from the voxels of its cube.
struct Expected {
    std::map<MaterialIndex, int> faces;
    std::set<std::array<int, 3>> columns;  ///< axis and the two other coordinates
};

Expected lookAt(const VoxelModel& model, const std::vector<Material>& materials, glm::ivec3 corner,
                int edge) {
    Expected expected;
    const VoxelBox box{corner, corner + edge};
    for (const test::Voxel& v : test::voxelsIn(model, box)) {
        const glm::ivec3 p = v.position;
        expected.columns.insert({0, p.y, p.z});
        expected.columns.insert({1, p.x, p.z});
        expected.columns.insert({2, p.x, p.y});
        for (const glm::ivec3 step : kSteps) {
            const auto beside = model.at(p + step);
            if (!beside || !isOpaque(materials[*beside])) ++expected.faces[v.material];
        }
    }
    return expected;
}

class LodOracle {
  public:
    LodOracle(const VoxelModel& model, const std::vector<Material>& materials, const OctreeRegion& region)
        : model_(model), materials_(materials), region_(region) {}

    void checkAll() {
        ASSERT_EQ(region_.lod.colors.size(), region_.tree.nodes.size());
        ASSERT_EQ(region_.lod.materials.size(), region_.tree.nodes.size());
        check(0, region_.originVoxels, 1 << region_.tree.depth);
    }

  private:
    void check(std::uint32_t index, glm::ivec3 corner, int edge) {
        checkNode(index, lookAt(model_, materials_, corner, edge), edge);
        const std::uint32_t inner = node::innerMask(region_.tree.nodes[index]);
        std::uint32_t child = inner != 0 ? region_.tree.firstChild(index) : 0;
        for (std::uint32_t slot = 0; slot < 8; ++slot) {
            if ((inner >> slot & 1u) == 0) continue;
            check(child++, corner + glm::ivec3{mortonDecode(slot)} * (edge / 2), edge / 2);
        }
    }

    void checkNode(std::uint32_t index, const Expected& expected, int edge) {
        const std::uint32_t color = region_.lod.colors[index];
        const double coverage = static_cast<double>(expected.columns.size()) / (3.0 * edge * edge);
        EXPECT_EQ(color >> 24, static_cast<std::uint32_t>(std::ceil(255 * coverage - 1e-9)))
            << "node " << index;
        glm::dvec3 sum{0};
        int total = 0;
        int most = 0;
        for (const auto& [material, faces] : expected.faces) {
            const glm::u8vec4 c = materials_[material].baseColor;
            sum += static_cast<double>(faces) * glm::dvec3{linearOf(c.r), linearOf(c.g), linearOf(c.b)};
            total += faces;
            most = std::max(most, faces);
        }
        for (int c = 0; c < 3; ++c) {
            const double mean = total == 0 ? 0.0 : srgbOf(sum[c] / total);
            EXPECT_NEAR((color >> (8 * c)) & 0xffu, mean, 0.6) << "node " << index << " channel " << c;
        }
        const std::uint16_t material = region_.lod.materials[index];
        if (total == 0) {
            EXPECT_EQ(material, 0u);
        } else {
            EXPECT_EQ(expected.faces.at(region_.palette[material]), most);
        }
    }

    const VoxelModel& model_;
    const std::vector<Material>& materials_;
    const OctreeRegion& region_;
};

TEST(Lod, EveryNodeIsTheMeanOfWhatCanBeSeen) {
    for (test::NamedModel& named : test::standardModels()) {
        if (named.name == "far apart" || named.name == "tiles") continue;  // too large to ask for every voxel
        SCOPED_TRACE(named.name);
        std::vector<VoxelModel> models;
        models.push_back(std::move(named.model));
        const VoxelAsset asset = test::assetOf(std::move(models));
        const OctreeAsset built = buildWithLod(asset);
        for (const OctreeRegion& region : built.models[0].regions) {
            LodOracle(asset.models[0], asset.materials, region).checkAll();
        }
    }
}

TEST(Lod, TilesOfOpaqueAndTransparentMaterial) {
    VoxelAsset asset = test::assetOf({});
    asset.models.emplace_back();
    VoxelModel& model = asset.models[0];
    model.fillTile({0, 0, 0}, 4, 1);
    model.fillTile({16, 0, 0}, 4, 3);  // glass beside metal: both sides of the border differ
    model.fillTile({0, 16, 0}, 3, 0);
    model.set({40, 1, 1}, 2);
    const OctreeAsset built = buildWithLod(asset);
    LodOracle(model, asset.materials, built.models[0].regions[0]).checkAll();
}

TEST(Lod, RegionsCoverEachOther) {
    VoxelAsset asset = test::assetOf({});
    asset.models.emplace_back();
    VoxelModel& model = asset.models[0];
    model.fillTile({0, 0, 0}, 8, 1);
    for (int y = 0; y < 4; ++y)
        for (int z = 0; z < 4; ++z) model.set({256, y, z}, static_cast<MaterialIndex>(z % 3));
    const OctreeAsset built = buildWithLod(asset);
    ASSERT_EQ(built.models[0].regions.size(), 2u);
    // The whole region: six sides of 256^2 less the 16 faces that the plate covers, all of one material.
    EXPECT_EQ(built.models[0].regions[0].lod.colors[0], 0xff000000u | (50u << 16) | (180u << 8) | 30u);
    EXPECT_EQ(built.models[0].regions[1].lod.materials.size(), built.models[0].regions[1].tree.nodes.size());
}

TEST(Lod, BuildingItChangesNothingElse) {
    std::vector<VoxelModel> models;
    models.push_back(test::patchyModel(4, 40));
    const VoxelAsset asset = test::assetOf(std::move(models));
    OctreeAsset with = buildWithLod(asset);
    const OctreeAsset without = buildOctrees(asset, Limits{}).value();
    EXPECT_TRUE(without.models[0].regions[0].lod.empty());
    with.models[0].regions[0].lod = {};
    EXPECT_EQ(encodePfVox(with, {}).value(), encodePfVox(without, {}).value());
}

TEST(Lod, SurvivesAFileAndIsTheSameForAnyNumberOfThreads) {
    std::vector<std::vector<std::byte>> files;
    for (const int threads : {1, 8}) {
        const tbb::global_control parallelism(tbb::global_control::max_allowed_parallelism, 8);
        tbb::task_arena arena(threads);
        arena.execute([&] {
            std::vector<VoxelModel> models;
            for (test::NamedModel& named : test::standardModels()) models.push_back(std::move(named.model));
            const OctreeAsset built = buildWithLod(test::assetOf(std::move(models)));
            files.push_back(encodePfVox(built, {}).value());
            EXPECT_TRUE(validatePfVox(files.back(), Limits{}).empty());
            DiagnosticList diagnostics;
            const OctreeAsset decoded = decodePfVox(files.back(), Limits{}, diagnostics).value();
            for (std::size_t m = 0; m < built.models.size(); ++m)
                for (std::size_t r = 0; r < built.models[m].regions.size(); ++r)
                    EXPECT_EQ(decoded.models[m].regions[r].lod, built.models[m].regions[r].lod);
        });
    }
    EXPECT_EQ(files[0], files[1]);
}

TEST(Lod, MoreThan256MaterialsTakeTwoBytes) {
    VoxelAsset asset;
    VoxelModel model;
    for (int i = 0; i < 1000; ++i) {
        asset.materials.push_back({.baseColor = {i & 255, i >> 8, 7, 255}});
        model.set({i % 10, i / 10 % 10, i / 100}, static_cast<MaterialIndex>(i));
    }
    asset.models.push_back(std::move(model));
    const OctreeAsset built = buildWithLod(asset);
    DiagnosticList diagnostics;
    const auto decoded = decodePfVox(encodePfVox(built, {}).value(), Limits{}, diagnostics);
    ASSERT_TRUE(decoded) << describe(decoded.error());
    EXPECT_EQ(decoded->models[0].regions[0].lod, built.models[0].regions[0].lod);
    EXPECT_GT(std::ranges::max(decoded->models[0].regions[0].lod.materials), 256);
}

}  // namespace
}  // namespace pfvox
