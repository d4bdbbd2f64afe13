// A round trip through our own file and back: source -> PF_VOX -> .vox shows the same world, cell by cell,
// with the same colors and material types.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <pfvox/convert.hpp>
#include <pfvox/export.hpp>
#include <pfvox/scene.hpp>

#include "support/corpus.hpp"
#include "support/vox_asset_cells.hpp"
#include "support/voxel_models.hpp"

namespace pfvox {
namespace {

using Cells = std::vector<std::pair<test::Cell, test::VoxelLook>>;

Cells allCells(const VoxelAsset& asset) {
    Cells cells;
    for (const Instance& instance : asset.instances) {
        const Cells some = test::worldCellsOf(asset, instance);
        cells.insert(cells.end(), some.begin(), some.end());
    }
    std::ranges::sort(cells);
    return cells;
}

Result<OctreeAsset> throughFile(const VoxelAsset& asset) {
    PFVOX_TRY(const OctreeAsset, built, buildOctrees(asset, Limits{}));
    PFVOX_TRY(const auto, bytes, encodePfVox(built, {}));
    DiagnosticList diagnostics;
    return decodePfVox(bytes, Limits{}, diagnostics);
}

void expectRoundTrip(const std::filesystem::path& source) {
    DiagnosticList diagnostics;
    auto imported = importFile(source, {}, Limits{}, diagnostics);
    ASSERT_TRUE(imported) << describe(imported.error());
    compactMaterials(*imported);
    const auto octrees = throughFile(*imported);
    ASSERT_TRUE(octrees) << describe(octrees.error());
    const auto exported = exportVox(*octrees, diagnostics);
    ASSERT_TRUE(exported) << describe(exported.error());
    const auto back = importBytes(*exported, "back.vox", {}, Limits{}, diagnostics);
    ASSERT_TRUE(back) << describe(back.error());
    const Cells expected = allCells(*imported);
    EXPECT_FALSE(expected.empty());
    EXPECT_TRUE(allCells(*back) == expected);
    EXPECT_EQ(back->layers.size(), imported->layers.size());
}

class VoxExportRoundTrip : public testing::TestWithParam<std::filesystem::path> {};

TEST_P(VoxExportRoundTrip, ShowsTheSameWorld) {
    expectRoundTrip(GetParam());
}

INSTANTIATE_TEST_SUITE_P(Corpus, VoxExportRoundTrip, testing::ValuesIn(test::convertibleVoxFiles()));
INSTANTIATE_TEST_SUITE_P(
    OwnData, VoxExportRoundTrip, testing::ValuesIn([] {
        std::vector<std::filesystem::path> files;
        for (const char* name : {"courtyard.vox", "tree.vox", "lamp.vox", "statue.vox"}) {
            files.push_back(std::filesystem::path(PFVOX_DATA_DIR) / name);
        }
        return files;
    }()));
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(VoxExportRoundTrip);

OctreeAsset oneModel(VoxelModel model) {
    std::vector<VoxelModel> models;
    models.push_back(std::move(model));
    VoxelAsset asset = test::assetOf(std::move(models));
    asset.instances[0].worldFromModel = Affine{asset.source.voxelSizeMetres};
    return buildOctrees(asset, Limits{}).value();
}

TEST(VoxExport, AModelLargerThan256BecomesSeveral) {
    DiagnosticList diagnostics;
    const VoxelModel model = test::randomModel(3, {-20, 0, 250}, {300, 5, 262}, 0.3, 4);
    const std::uint64_t voxels = model.voxelCount();
    const auto exported =
        exportVox(oneModel(test::randomModel(3, {-20, 0, 250}, {300, 5, 262}, 0.3, 4)), diagnostics);
    ASSERT_TRUE(exported) << describe(exported.error());
    const auto back = importBytes(*exported, "back.vox", {.voxelSizeMetres = 0.125}, Limits{}, diagnostics);
    ASSERT_TRUE(back) << describe(back.error());
    EXPECT_GT(back->models.size(), 1u);
    const Cells cells = allCells(*back);
    EXPECT_EQ(cells.size(), voxels);
    for (const auto& [cell, look] : cells) {
        ASSERT_TRUE(model.at({cell[0], cell[1], cell[2]})) << cell[0] << ' ' << cell[1] << ' ' << cell[2];
    }
}

// Floats tell whole voxels apart up to 2^24 edges of 1 m, and the edges are 0.125 m here.
TEST(VoxExport, InstancesFarAwayStayWhereTheyAre) {
    VoxelAsset asset = test::assetOf({});
    asset.models.push_back(test::boxModel({0, 0, 0}, {2, 2, 2}, 1));
    asset.instances.clear();
    const double voxel = asset.source.voxelSizeMetres = 0.1;
    const std::vector<double> places{0, 65535, 65536.0 * 3 + 1, 134217727, 134217728, 1073741821};
    for (const double at : places) {
        Affine m{voxel};
        m[3] = voxel * glm::dvec3(at, -at, 1.0);
        asset.instances.push_back({.model = 0, .worldFromModel = m});
    }
    const auto octrees = throughFile(asset);
    ASSERT_TRUE(octrees) << describe(octrees.error());
    for (std::size_t i = 0; i < places.size(); ++i)
        EXPECT_EQ(octrees->instances[i].worldFromModel[3], asset.instances[i].worldFromModel[3]) << places[i];
    DiagnosticList diagnostics;
    const auto exported = exportVox(*octrees, diagnostics);
    ASSERT_TRUE(exported) << describe(exported.error());
    const auto back = importBytes(*exported, "back.vox", {.voxelSizeMetres = voxel}, Limits{}, diagnostics);
    ASSERT_TRUE(back) << describe(back.error());
    ASSERT_EQ(back->instances.size(), places.size());
    for (std::size_t i = 0; i < places.size(); ++i) {
        const WorldBounds box = boundsOf(buildOctrees(*back, Limits{}).value(), Affine{1.0});
        EXPECT_NEAR(box.max.x, voxel * (places.back() + 2), 1e-6);
        const glm::dvec3 low =
            back->instances[i].worldFromModel * glm::dvec4(back->models[0].bounds().min, 1.0);
        EXPECT_NEAR(low.x / voxel, places[i], 1e-6) << places[i];
        EXPECT_NEAR(low.y / voxel, -places[i], 1e-6) << places[i];
    }
}

TEST(VoxExport, NearTheOriginAFileKeepsItsFirstVersion) {
    const OctreeAsset near = oneModel(test::boxModel({0, 0, 0}, {2, 3, 4}, 1));
    OctreeAsset far = near;
    far.instances[0].worldFromModel[3].x = 5.2e6 + 0.2;
    const auto minorOf = [](const OctreeAsset& asset) {
        return static_cast<int>((*encodePfVox(asset, {}))[10]);
    };
    EXPECT_EQ(minorOf(near), 0);
    EXPECT_EQ(minorOf(far), 1);
}

TEST(VoxExport, WhatAVoxFileCannotHoldIsRefused) {
    DiagnosticList diagnostics;
    OctreeAsset asset = oneModel(test::boxModel({0, 0, 0}, {2, 3, 4}, 1));
    asset.instances[0].worldFromModel[3].x += 0.3 * asset.source.voxelSizeMetres;
    EXPECT_EQ(exportVox(asset, diagnostics).error().code, ErrorCode::UnsupportedFeature);

    asset = oneModel(test::boxModel({0, 0, 0}, {2, 3, 4}, 1));
    asset.instances[0].worldFromModel[0] = asset.instances[0].worldFromModel[1];
    EXPECT_EQ(exportVox(asset, diagnostics).error().code, ErrorCode::UnsupportedFeature);

    asset = oneModel(test::boxModel({0, 0, 0}, {2, 3, 4}, 1));
    asset.materials.resize(256);
    const auto refused = exportVox(asset, diagnostics);
    EXPECT_EQ(refused.error().code, ErrorCode::LimitExceeded);
    EXPECT_THAT(refused.error().message, testing::HasSubstr("255"));

    EXPECT_EQ(exportVox(oneModel({}), diagnostics).error().code, ErrorCode::NothingToConvert);
}

TEST(VoxExport, MaterialsComeBack) {
    DiagnosticList diagnostics;
    VoxelModel model;
    for (int i = 0; i < 4; ++i) model.set({i, 0, 0}, static_cast<MaterialIndex>(i));
    const OctreeAsset asset = oneModel(std::move(model));
    const auto back =
        importBytes(exportVox(asset, diagnostics).value(), "back.vox", {}, Limits{}, diagnostics);
    ASSERT_TRUE(back) << describe(back.error());
    EXPECT_NEAR(back->materials[1].metalness, 0.75f, 1e-4f);
    EXPECT_NEAR(back->materials[1].roughness, 0.25f, 1e-4f);
    EXPECT_NEAR(back->materials[2].emissionStrength, 12.5f, 1e-3f);
    EXPECT_NEAR(back->materials[3].indexOfRefraction, 1.33f, 1e-4f);
    EXPECT_NEAR(back->materials[3].transparency, 0.8f, 1e-4f);
}

}  // namespace
}  // namespace pfvox
