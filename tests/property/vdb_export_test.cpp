// A round trip through OpenVDB: octrees -> .vdb -> import -> octrees gives the same PF_VOX file, byte by
// byte; and OpenVDB itself sees what we say is in the file.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <openvdb/io/File.h>
#include <openvdb/openvdb.h>

#include <chrono>
#include <map>
#include <pfvox/convert.hpp>
#include <pfvox/export.hpp>
#include <pfvox/files.hpp>
#include <random>

#include "support/corpus.hpp"
#include "support/import_helpers.hpp"
#include "support/process.hpp"
#include "support/temp_folder.hpp"
#include "support/voxel_models.hpp"

namespace pfvox::test {
namespace {

OctreeAsset built(VoxelAsset asset) {
    compactMaterials(asset);
    return buildOctrees(asset, Limits{}).value();
}

Bytes exported(const OctreeAsset& asset) {
    DiagnosticList diagnostics;
    auto bytes = exportVdb(asset, Limits{}, diagnostics);
    EXPECT_TRUE(bytes) << describe(bytes.error());
    return bytes.value_or(Bytes{});
}

Bytes pfVoxOf(const OctreeAsset& asset) {
    return encodePfVox(asset, {}).value();
}

/// Models in the order in which instances show them, which is the order that a .vdb keeps.
void sortModels(OctreeAsset& asset) {
    std::vector<OctreeModel> models;
    std::map<std::uint32_t, std::uint32_t> newIndex;
    for (Instance& instance : asset.instances) {
        const auto [at, isNew] = newIndex.emplace(instance.model, static_cast<std::uint32_t>(models.size()));
        if (isNew) models.push_back(std::move(asset.models[instance.model]));
        instance.model = at->second;
    }
    asset.models = std::move(models);
}

/// What a .vdb has no place for is set equal; all else must be.
void expectRoundTrip(OctreeAsset asset) {
    sortModels(asset);
    Imported back = importAs(exported(asset), "back.vdb");
    ASSERT_TRUE(back.result) << back.errorText();
    for (const Diagnostic& d : back.diagnostics) EXPECT_EQ(d.severity, Severity::Note) << d.message;
    VoxelAsset again = std::move(back.result).value();
    EXPECT_EQ(again.source.voxelSizeMetres, asset.source.voxelSizeMetres);
    EXPECT_EQ(again.source.format, "vdb");
    again.source = asset.source;
    again.cameras = asset.cameras;
    again.layers = asset.layers;
    for (std::size_t i = 0; i < again.instances.size(); ++i) {
        EXPECT_EQ(again.instances[i].layer >= 0, asset.instances[i].layer >= 0);
        again.instances[i].layer = asset.instances[i].layer;
        // Zero may have another sign.
        EXPECT_EQ(glm::mat4x3(again.instances[i].worldFromModel),
                  glm::mat4x3(asset.instances[i].worldFromModel));
        again.instances[i].worldFromModel = asset.instances[i].worldFromModel;
    }
    const OctreeAsset octrees = built(std::move(again));
    EXPECT_EQ(octrees.materials, asset.materials);
    EXPECT_TRUE(pfVoxOf(octrees) == pfVoxOf(asset));
}

Affine randomAffine(std::mt19937& random) {
    std::uniform_real_distribution<double> entry(-2.0, 2.0);
    Affine affine;
    do {
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 3; ++row) affine[column][row] = static_cast<float>(entry(random));
    } while (std::abs(glm::determinant(glm::dmat3{affine})) < 0.1);
    return affine;
}

TEST(VdbExport, StandardModelsComeBackAsTheyWere) {
    for (NamedModel& named : standardModels()) {
        SCOPED_TRACE(named.name);
        if (named.model.voxelCount() == 0) continue;
        named.model.name = named.name;
        std::vector<VoxelModel> models;
        models.push_back(std::move(named.model));
        expectRoundTrip(built(assetOf(std::move(models))));
    }
}

TEST(VdbExport, RandomAssetsComeBackAsTheyWere) {
    std::mt19937 random(7);
    const auto seed = [&] { return static_cast<std::uint32_t>(random()); };
    for (std::uint32_t round = 0; round < 30; ++round) {
        SCOPED_TRACE(round);
        std::vector<VoxelModel> models;
        const std::size_t modelCount = 1 + random() % 3;
        for (std::size_t m = 0; m < modelCount; ++m) {
            models.push_back(random() % 2 == 0 ? patchyModel(seed(), 10 + static_cast<int>(random() % 60))
                                               : randomModel(seed(), {-9, -5, -300}, {8, 12, -280}, 0.4, 4));
            models.back().name = "model " + std::to_string(m);
            models.back().set({0, 0, static_cast<int>(m)}, static_cast<MaterialIndex>(m));  // none is empty
        }
        VoxelAsset asset = assetOf(std::move(models));
        for (std::size_t extra = random() % 4; extra > 0; --extra) {
            asset.instances.push_back({.model = static_cast<std::uint32_t>(random() % modelCount),
                                       .name = "copy\n" + std::to_string(extra),
                                       .layer = -1});
        }
        for (Instance& instance : asset.instances) instance.worldFromModel = randomAffine(random);
        asset.materials[0].name = "a \\ b\nc=d";
        expectRoundTrip(built(std::move(asset)));
    }
}

class VdbExportCorpus : public testing::TestWithParam<std::filesystem::path> {};

TEST_P(VdbExportCorpus, ComesBackAsItWas) {
    DiagnosticList diagnostics;
    auto imported = importFile(GetParam(), {}, Limits{}, diagnostics);
    ASSERT_TRUE(imported) << describe(imported.error());
    OctreeAsset asset = built(*std::move(imported));
    // Instances of models without voxels and models that nothing shows are not in a .vdb file.
    const bool allShown =
        std::ranges::all_of(asset.models, [](const OctreeModel& m) { return m.voxelCount > 0; });
    if (!allShown) GTEST_SKIP() << "has an empty model";
    expectRoundTrip(std::move(asset));
}

std::vector<std::filesystem::path> sources() {
    std::vector<std::filesystem::path> files = convertibleVoxFiles();
    for (const char* name : {"courtyard.vox", "tree.vox", "lamp.vox", "statue.vox"}) {
        files.push_back(std::filesystem::path(PFVOX_DATA_DIR) / name);
    }
    return files;
}
INSTANTIATE_TEST_SUITE_P(Files, VdbExportCorpus, testing::ValuesIn(sources()));

OctreeAsset oneModel(VoxelModel model) {
    model.name = "thing";
    std::vector<VoxelModel> models;
    models.push_back(std::move(model));
    VoxelAsset asset = assetOf(std::move(models));
    asset.instances[0].worldFromModel = Affine{asset.source.voxelSizeMetres};
    return buildOctrees(asset, Limits{}).value();
}

TEST(VdbExport, OpenVdbSeesWhatIsThere) {
    VoxelModel model;
    model.fillTile({-128, 0, 128}, 7, 1);
    model.fillTile({8, 8, 8}, 3, 2);
    model.set({1, -2, 3}, 0);
    model.set({300, 2, 3}, 3);
    TempFolder folder;
    const Bytes bytes = exported(oneModel(std::move(model)));
    ASSERT_TRUE(pfvox::io::writeFileAtomically(folder / "thing.vdb", bytes));

    openvdb::initialize();
    openvdb::io::File file((folder / "thing.vdb").string());
    file.open();
    const openvdb::GridPtrVecPtr grids = file.getGrids();
    ASSERT_EQ(grids->size(), 3u);
    constexpr std::uint64_t kVoxels = (1ull << 21) + 512 + 2;
    for (const auto& grid : *grids) {
        EXPECT_EQ(grid->activeVoxelCount(), kVoxels) << grid->getName();
        EXPECT_EQ(grid->constBaseTree().activeTileCount(), 2u) << grid->getName();
        EXPECT_EQ(grid->constBaseTree().leafCount(), 2u) << grid->getName();
        // The center of voxel (0, 0, 0), whose edge is an eighth of a metre.
        EXPECT_EQ(grid->indexToWorld(openvdb::Coord(0, 0, 0)), openvdb::Vec3d(0.0625));
        EXPECT_EQ(grid->voxelSize(), openvdb::Vec3d(0.125));
    }
    const auto density = openvdb::gridPtrCast<openvdb::FloatGrid>(file.readGrid("density"));
    EXPECT_EQ(density->getGridClass(), openvdb::GRID_FOG_VOLUME);
    EXPECT_EQ(density->tree().getValue(openvdb::Coord(1, -2, 3)), 1.0f);
    EXPECT_EQ(density->tree().getValue(openvdb::Coord(0, -2, 3)), 0.0f);
    const auto material = openvdb::gridPtrCast<openvdb::Int32Grid>(file.readGrid("material"));
    EXPECT_EQ(material->tree().getValue(openvdb::Coord(-100, 5, 200)), 2);
    EXPECT_EQ(material->tree().getValue(openvdb::Coord(300, 2, 3)), 4);
    EXPECT_EQ(material->tree().getValue(openvdb::Coord(301, 2, 3)), 0);
    const auto color = openvdb::gridPtrCast<openvdb::Vec3SGrid>(file.readGrid("Cd"));
    const openvdb::Vec3s green = color->tree().getValue(openvdb::Coord(-100, 5, 200));  // sRGB 30, 180, 50
    EXPECT_NEAR(green.x(), 0.01298f, 1e-5f);
    EXPECT_NEAR(green.y(), 0.45641f, 1e-5f);
    EXPECT_NEAR(green.z(), 0.03190f, 1e-5f);
    EXPECT_EQ(file.getMetadata()->metaValue<std::string>("creator"), "pfvox");
}

TEST(VdbExport, OpenVdbsOwnToolListsTheGrids) {
    const std::string tool = PFVOX_VDB_PRINT;
    if (tool.empty() || !std::filesystem::exists(tool))
        GTEST_SKIP() << "vdb_print is not installed (libopenvdb-tools)";
    TempFolder folder;
    ASSERT_TRUE(pfvox::io::writeFileAtomically(folder / "thing.vdb",
                                               exported(oneModel(boxModel({0, 0, 0}, {9, 2, 3}, 1)))));
    const ProcessResult result = runProcess({tool, "-l", (folder / "thing.vdb").string()});
    EXPECT_EQ(result.exitCode, 0) << result.err;
    EXPECT_THAT(result.out, testing::AllOf(testing::HasSubstr("density"), testing::HasSubstr("Cd"),
                                           testing::HasSubstr("material"), testing::HasSubstr("54")))
        << result.out;
}

TEST(VdbExport, DensityAndColorsAloneAreTheModelToo) {
    const OctreeAsset asset = oneModel(patchyModel(5, 40));
    ImportSettings settings;
    settings.vdb.grids = {"density"};
    const Imported imported = importAs(exported(asset), "thing.vdb", settings);
    ASSERT_TRUE(imported.result) << imported.errorText();
    const VoxelModel& model = imported.result->models[0];
    EXPECT_EQ(model.voxelCount(), asset.models[0].voxelCount);
    for (const Voxel& v : voxelsIn(model, model.bounds())) {
        const auto expected = asset.models[0].at(v.position);
        ASSERT_TRUE(expected);
        EXPECT_EQ(glm::u8vec3(imported.result->materials[v.material].baseColor),
                  glm::u8vec3(asset.materials[*expected].baseColor));
    }
}

TEST(VdbExport, InstancesShareTheirTrees) {
    OctreeAsset asset = oneModel(randomModel(2, {0, 0, 0}, {60, 60, 60}, 0.5, 4));
    const std::size_t once = exported(asset).size();
    for (int i = 0; i < 50; ++i) {
        asset.instances.push_back(asset.instances[0]);
        asset.instances.back().worldFromModel[3].x += i;
    }
    const Bytes bytes = exported(asset);
    EXPECT_LT(bytes.size(), once + 51 * 3 * 1024);
    const Imported imported = importAs(bytes, "many.vdb");
    ASSERT_TRUE(imported.result) << imported.errorText();
    EXPECT_EQ(imported.result->models.size(), 1u);
    EXPECT_EQ(imported.result->instances.size(), 51u);
}

TEST(VdbExport, EqualAssetsGiveEqualBytes) {
    const OctreeAsset asset = oneModel(patchyModel(3, 60));
    const Bytes bytes = exported(asset);
    EXPECT_TRUE(bytes == exported(asset));
    const std::string uuid(reinterpret_cast<const char*>(bytes.data()) + 21, 36);
    EXPECT_THAT(uuid, testing::ContainsRegex(
                          "^[0-9a-f]{8}-[0-9a-f]{4}-8[0-9a-f]{3}-[89ab][0-9a-f]{3}-[0-9a-f]{12}$"));
    const Bytes other = exported(oneModel(patchyModel(4, 60)));
    EXPECT_NE(uuid, std::string(reinterpret_cast<const char*>(other.data()) + 21, 36));
}

TEST(VdbExport, LargeSolidsStayTiles) {
    constexpr int kRadius = 288;  // a ball of 10^8 voxels, in cells of 8^3
    VoxelModel ball;
    for (int z = -kRadius; z < kRadius; z += 8)
        for (int y = -kRadius; y < kRadius; y += 8)
            for (int x = -kRadius; x < kRadius; x += 8) {
                const glm::ivec3 center = glm::ivec3{x, y, z} + 4;
                if (center.x * center.x + center.y * center.y + center.z * center.z < kRadius * kRadius)
                    ball.fillTile({x, y, z}, 3, 1);
            }
    ball.fillTile({4096, 0, 0}, 12, 2);
    const OctreeAsset asset = oneModel(std::move(ball));
    EXPECT_GT(asset.models[0].voxelCount, 100'000'000u + (1ull << 36));

    const auto start = std::chrono::steady_clock::now();
    const Bytes bytes = exported(asset);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    RecordProperty("seconds", std::to_string(seconds));
    RecordProperty("bytes", std::to_string(bytes.size()));
    EXPECT_LT(seconds, 10.0);
    EXPECT_LT(bytes.size(), 4u << 20);
    const Imported imported = importAs(bytes, "ball.vdb");
    ASSERT_TRUE(imported.result) << imported.errorText();
    EXPECT_EQ(imported.result->models[0].voxelCount(), asset.models[0].voxelCount);
}

TEST(VdbExport, WhatAVdbFileCannotHoldIsRefused) {
    DiagnosticList diagnostics;
    OctreeAsset asset = oneModel(boxModel({0, 0, 0}, {2, 3, 4}, 1));
    asset.instances[0].worldFromModel[0] = asset.instances[0].worldFromModel[1];
    EXPECT_EQ(exportVdb(asset, Limits{}, diagnostics).error().code, ErrorCode::UnsupportedFeature);

    asset.instances[0].worldFromModel[0] = {std::nan(""), 0, 0};
    EXPECT_EQ(exportVdb(asset, Limits{}, diagnostics).error().code, ErrorCode::UnsupportedFeature);

    asset = oneModel(boxModel({0, 0, 0}, {2, 3, 4}, 1));
    EXPECT_EQ(exportVdb(asset, {.maxMemoryBytes = 4096}, diagnostics).error().code, ErrorCode::LimitExceeded);

    asset.instances.clear();
    EXPECT_EQ(exportVdb(asset, Limits{}, diagnostics).error().code, ErrorCode::NothingToConvert);
    EXPECT_EQ(exportVdb(oneModel({}), Limits{}, diagnostics).error().code, ErrorCode::NothingToConvert);
}

TEST(VdbExport, HiddenAndLayersComeBack) {
    std::vector<VoxelModel> models;
    models.push_back(boxModel({0, 0, 0}, {2, 2, 2}, 0));
    models.push_back(boxModel({0, 0, 0}, {3, 3, 3}, 1));
    VoxelAsset asset = assetOf(std::move(models));
    asset.instances[0].layer = 1;
    const Bytes bytes = exported(built(std::move(asset)));
    const Imported imported = importAs(bytes, "layers.vdb");
    ASSERT_TRUE(imported.result) << imported.errorText();
    const auto& result = *imported.result;
    EXPECT_EQ(result.layers, (std::vector<Layer>{{.name = "draft", .hidden = true}, {.name = "ground"}}));
    EXPECT_EQ(result.instances[0].layer, 0);
    EXPECT_EQ(result.instances[1].layer, 1);
    EXPECT_FALSE(result.instances[0].hidden);
    EXPECT_TRUE(result.instances[1].hidden);
    const Imported shown = importAs(bytes, "layers.vdb", {.includeHidden = true});
    EXPECT_FALSE(shown.result->instances[1].hidden);
    EXPECT_FALSE(shown.result->layers[0].hidden);
}

}  // namespace
}  // namespace pfvox::test
