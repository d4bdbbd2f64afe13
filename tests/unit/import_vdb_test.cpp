#include <openvdb/tools/LevelSetSphere.h>
#include <pfvox/import.hpp>

#include <chrono>
#include <cmath>

#include "support/corpus.hpp"
#include "support/import_helpers.hpp"
#include "support/vdb_writer.hpp"

namespace pfvox::test {
namespace {

using openvdb::Coord;
using openvdb::FloatGrid;

FloatGrid::Ptr fogGrid(const std::string& name, const std::vector<Coord>& voxels) {
    openvdb::initialize();
    auto grid = FloatGrid::create(0.0f);
    grid->setName(name);
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    for (const Coord& voxel : voxels) grid->tree().setValueOn(voxel, 1.0f);
    return grid;
}

Imported importGrids(const openvdb::GridPtrVec& grids, const ImportSettings& settings = {}) {
    return importAs(writeVdb(grids), "test.vdb", settings);
}

TEST(ImportVdb, TilesStayTiles) {
    auto grid = fogGrid("tiles", {});
    grid->tree().addTile(1, Coord(8, 16, 24), 1.0f, true);
    grid->tree().addTile(2, Coord(-128, 0, 128), 1.0f, true);
    grid->tree().addTile(3, Coord(4096, -4096, 0), 1.0f, true);
    for (const UpAxis up : {UpAxis::Y, UpAxis::Z}) {
        ImportSettings settings;
        settings.vdb.upAxis = up;
        const Imported imported = importGrids({grid}, settings);
        ASSERT_TRUE(imported.result) << imported.errorText();
        const VoxelModel& model = imported.result->models[0];
        EXPECT_EQ(model.voxelCount(), (1ull << 9) + (1ull << 21) + (1ull << 36));
        EXPECT_LT(model.memoryBytes(), 2u << 20);
        const auto at = [&](int x, int y, int z) {
            return model.at(up == UpAxis::Y ? glm::ivec3{x, y, z} : glm::ivec3{x, z, -y - 1}).has_value();
        };
        EXPECT_TRUE(at(8, 16, 24) && at(15, 23, 31) && at(-128, 0, 128) && at(-1, 127, 255));
        EXPECT_TRUE(at(4096, -4096, 0) && at(8191, -1, 4095));
        EXPECT_FALSE(at(7, 16, 24) || at(16, 16, 24) || at(0, 0, 128) || at(4096, 0, 0) || at(4095, -1, 0));
    }
}

TEST(ImportVdb, LevelSetsAreSolidInside) {
    openvdb::initialize();
    auto sphere = openvdb::tools::createLevelSetSphere<FloatGrid>(40.0f, openvdb::Vec3f(3.0f), 1.0f);
    sphere->setName("sphere");
    const Imported imported = importGrids({sphere});
    ASSERT_TRUE(imported.result) << imported.errorText();
    const std::uint64_t voxels = imported.result->models[0].voxelCount();
    EXPECT_EQ(voxels, countSolid(*sphere, true));
    EXPECT_GT(voxels, sphere->activeVoxelCount()) << "the interior is not active";
    EXPECT_NEAR(static_cast<double>(voxels), 4.0 / 3.0 * M_PI * 40 * 40 * 40, 3000.0);
    EXPECT_TRUE(imported.result->models[0].at({3, 3, 3}));
}

TEST(ImportVdb, UnmarkedLevelSetsAreRecognised) {
    openvdb::initialize();
    auto sphere = openvdb::tools::createLevelSetSphere<FloatGrid>(10.0f, openvdb::Vec3f(0.0f), 1.0f);
    sphere->setGridClass(openvdb::GRID_FOG_VOLUME);
    const Imported imported = importGrids({sphere});
    ASSERT_TRUE(imported.result) << imported.errorText();
    EXPECT_TRUE(imported.reported("vdb-level-set-guessed"));
    EXPECT_EQ(imported.result->models[0].voxelCount(), countSolid(*sphere, true));
}

TEST(ImportVdb, FogThresholdIsExclusive) {
    auto grid = fogGrid("density", {Coord(0, 0, 0)});
    grid->tree().setValueOn(Coord(1, 0, 0), 0.5f);
    grid->tree().setValueOn(Coord(2, 0, 0), 0.0f);
    grid->tree().setValueOff(Coord(3, 0, 0), 5.0f);
    EXPECT_EQ(importGrids({grid}).result.value().models[0].voxelCount(), 2u);
    ImportSettings settings;
    settings.vdb.threshold = 0.5;
    EXPECT_EQ(importGrids({grid}, settings).result.value().models[0].voxelCount(), 1u);
    settings.vdb.threshold = 2.0;
    const Imported empty = importGrids({grid}, settings);
    ASSERT_FALSE(empty.result);
    EXPECT_THAT(empty.errorText(), testing::HasSubstr("vdb.threshold = 2"));
}

TEST(ImportVdb, VoxelsKeepTheirPlacesInBricks) {
    const std::vector<Coord> voxels{{0, 0, 0}, {1, 2, 3}, {-1, -2, -3}, {7, 0, 8}, {-9, 255, 256}};
    const Imported imported = importGrids({fogGrid("a", voxels)});
    ASSERT_TRUE(imported.result) << imported.errorText();
    std::set<std::array<int, 3>> expected;
    for (const Coord& v : voxels) expected.insert({v.x(), v.y(), v.z()});
    EXPECT_EQ(voxelSet(imported.result->models[0]), expected);
    ImportSettings settings;
    settings.vdb.upAxis = UpAxis::Z;
    const Imported turned = importGrids({fogGrid("a", voxels)}, settings);
    expected.clear();
    for (const Coord& v : voxels) expected.insert({v.x(), v.z(), -v.y() - 1});
    EXPECT_EQ(voxelSet(turned.result->models[0]), expected);
}

TEST(ImportVdb, TransformsPlaceVoxelCenters) {
    auto grid = fogGrid("a", {Coord(0, 0, 0)});
    auto transform = openvdb::math::Transform::createLinearTransform(0.25);
    transform->postTranslate(openvdb::Vec3d(1.0, 2.0, 3.0));
    grid->setTransform(transform);
    for (const UpAxis up : {UpAxis::Y, UpAxis::Z}) {
        ImportSettings settings;
        settings.vdb.upAxis = up;
        const Imported imported = importGrids({grid}, settings);
        ASSERT_TRUE(imported.result) << imported.errorText();
        EXPECT_DOUBLE_EQ(imported.result->source.voxelSizeMetres, 0.25);
        const Affine& world = imported.result->instances[0].worldFromModel;
        // The center of index voxel (4, 8, 12) lies at (2, 4, 6) in the file's world.
        const glm::dvec3 voxel = up == UpAxis::Y ? glm::dvec3{4, 8, 12} : glm::dvec3{4, 12, -9};
        const glm::dvec3 center = world * glm::dvec4{voxel + 0.5, 1.0};
        const glm::dvec3 expected = up == UpAxis::Y ? glm::dvec3{2, 4, 6} : glm::dvec3{2, 6, -4};
        EXPECT_LT(glm::distance(center, expected), 1e-12);
        EXPECT_GT(glm::determinant(glm::dmat3{world}), 0.0) << "a mirror";
    }
    ImportSettings settings;
    settings.voxelSizeMetres = 0.5;
    const Affine scaled = importGrids({grid}, settings).result.value().instances[0].worldFromModel;
    EXPECT_LT(glm::distance(glm::dvec3{scaled * glm::dvec4{0.5, 0.5, 0.5, 1}}, glm::dvec3{2, 4, 6}), 1e-12);
}

TEST(ImportVdb, IntegersAreMaterialIds) {
    openvdb::initialize();
    auto ids = openvdb::Int32Grid::create(0);
    ids->setName("ids");
    for (int x = 0; x < 20; ++x) ids->tree().setValueOn(Coord(x, 0, 0), x % 4);
    auto wide = openvdb::Int64Grid::create(0);
    wide->setName("wide");
    wide->tree().setValueOn(Coord(0, 0, 0), 1'000'000'000'000);
    wide->tree().addTile(1, Coord(8, 8, 8), 3, true);
    const Imported imported = importGrids({ids, wide});
    ASSERT_TRUE(imported.result) << imported.errorText();
    const VoxelAsset& asset = *imported.result;
    ASSERT_EQ(asset.models.size(), 2u);
    const auto nameAt = [&](std::size_t model, glm::ivec3 v) {
        return asset.materials.at(*asset.models[model].at(v)).name;
    };
    EXPECT_EQ(asset.models[0].voxelCount(), 15u);
    EXPECT_FALSE(asset.models[0].at({4, 0, 0}));
    EXPECT_EQ(nameAt(0, {1, 0, 0}), "1");
    EXPECT_EQ(nameAt(0, {7, 0, 0}), "3");
    EXPECT_EQ(nameAt(1, {0, 0, 0}), "1000000000000");
    EXPECT_EQ(nameAt(1, {15, 15, 15}), "3");
    EXPECT_EQ(asset.models[0].at({7, 0, 0}), asset.models[1].at({15, 15, 15})) << "one id, one material";
    EXPECT_NE(asset.materials[1].baseColor, asset.materials[2].baseColor);
}

TEST(ImportVdb, BoolsAndMasksAreTopology) {
    openvdb::initialize();
    auto flags = openvdb::BoolGrid::create(false);
    flags->setName("flags");
    flags->tree().setValueOn(Coord(0, 0, 0), true);
    flags->tree().setValueOn(Coord(1, 0, 0), false);
    flags->tree().addTile(1, Coord(8, 0, 0), true, true);
    auto mask = openvdb::MaskGrid::create();
    mask->setName("mask");
    mask->tree().setValueOn(Coord(5, 6, 7));
    const Imported imported = importGrids({flags, mask});
    ASSERT_TRUE(imported.result) << imported.errorText();
    EXPECT_EQ(imported.result->models[0].voxelCount(), 513u);
    EXPECT_EQ(imported.result->models[1].voxelCount(), 1u);
}

TEST(ImportVdb, DoublesAndHalvesAreRead) {
    openvdb::initialize();
    auto doubles = openvdb::DoubleGrid::create(0.0);
    doubles->setName("doubles");
    doubles->tree().setValueOn(Coord(1, 1, 1), 1e-300);
    auto halves = fogGrid("halves", {Coord(1, 2, 3), Coord(300, 2, 3)});
    halves->setSaveFloatAsHalf(true);
    const Imported imported = importGrids({doubles, halves});
    ASSERT_TRUE(imported.result) << imported.errorText();
    EXPECT_EQ(imported.result->models[0].voxelCount(), 1u);
    EXPECT_EQ(imported.result->models[1].voxelCount(), 2u);
}

TEST(ImportVdb, ColorsComeFromCd) {
    auto density = fogGrid("density", {Coord(0, 0, 0), Coord(1, 0, 0), Coord(2, 0, 0), Coord(3, 0, 0)});
    density->tree().addTile(2, Coord(128, 0, 0), 1.0f, true);
    auto cd = openvdb::Vec3SGrid::create(openvdb::Vec3s(0.0f));
    cd->setName("Cd");
    cd->tree().setValueOn(Coord(0, 0, 0), openvdb::Vec3s(1.0f, 0.0f, 0.0f));
    cd->tree().setValueOn(Coord(1, 0, 0), openvdb::Vec3s(0.5f, -3.0f, 7.0f));
    cd->tree().setValueOn(Coord(2, 0, 0), openvdb::Vec3s(NAN, 0.0f, 0.0031308f));
    cd->tree().addTile(2, Coord(128, 0, 0), openvdb::Vec3s(0.0f, 1.0f, 0.0f), true);
    cd->tree().setValueOn(Coord(130, 5, 6), openvdb::Vec3s(0.0f, 0.0f, 1.0f));
    const Imported imported = importGrids({density, cd});
    ASSERT_TRUE(imported.result) << imported.errorText();
    const VoxelAsset& asset = *imported.result;
    ASSERT_EQ(asset.models.size(), 1u) << "the color grid itself is no model beside a density";
    const auto clamped = std::ranges::find(imported.diagnostics, "vdb-colors-clamped", &Diagnostic::id);
    ASSERT_NE(clamped, imported.diagnostics.end());
    EXPECT_THAT(clamped->message, testing::StartsWith("2 values of grid \"Cd\""));
    EXPECT_EQ(asset.models[0].voxelCount(), 4u + (1u << 21));
    const auto colorAt = [&](glm::ivec3 v) {
        return glm::ivec3{asset.materials.at(*asset.models[0].at(v)).baseColor};
    };
    EXPECT_EQ(colorAt({0, 0, 0}), (glm::ivec3{255, 0, 0}));
    EXPECT_EQ(colorAt({1, 0, 0}), (glm::ivec3{188, 0, 255}));
    EXPECT_EQ(colorAt({2, 0, 0}), (glm::ivec3{0, 0, 10}));
    EXPECT_EQ(colorAt({3, 0, 0}), (glm::ivec3{0, 0, 0}));
    EXPECT_EQ(colorAt({128, 0, 0}), (glm::ivec3{0, 255, 0}));
    EXPECT_EQ(colorAt({255, 127, 127}), (glm::ivec3{0, 255, 0}));
    EXPECT_EQ(colorAt({130, 5, 6}), (glm::ivec3{0, 0, 255}));
    EXPECT_EQ(colorAt({130, 5, 7}), (glm::ivec3{0, 255, 0}));
    EXPECT_LT(asset.models[0].memoryBytes(), 1u << 20) << "only the brick with two colors may be taken apart";
}

TEST(ImportVdb, GradientsAreQuantisedDeterministically) {
    openvdb::initialize();
    auto cd = openvdb::Vec3SGrid::create(openvdb::Vec3s(0.0f));
    cd->setName("color");
    for (int x = 0; x < 40; ++x)
        for (int y = 0; y < 40; ++y)
            for (int z = 0; z < 40; ++z) {
                cd->tree().setValueOn(Coord(x, y, z),
                                      openvdb::Vec3s(static_cast<float>(x) / 39, static_cast<float>(y) / 39,
                                                     static_cast<float>(z) / 39));
            }
    const Imported first = importGrids({cd});
    const Imported second = importGrids({cd});
    ASSERT_TRUE(first.result) << first.errorText();
    EXPECT_TRUE(first.reported("vdb-colors-quantised"));
    EXPECT_EQ(first.result->materials.size(), 4097u);
    EXPECT_EQ(first.result->materials, second.result->materials);
    EXPECT_EQ(first.result->models[0].voxelCount(), 64000u);
    const auto corner = first.result->materials[*first.result->models[0].at({39, 39, 39})].baseColor;
    EXPECT_GT(int{corner.r}, 235);
    EXPECT_GT(int{corner.b}, 235);
}

TEST(ImportVdb, OtherTransformsOfColorsAreReported) {
    auto density = fogGrid("density", {Coord(0, 0, 0)});
    auto cd = openvdb::Vec3SGrid::create(openvdb::Vec3s(1.0f));
    cd->setName("Cd");
    cd->tree().setValueOn(Coord(0, 0, 0), openvdb::Vec3s(1.0f));
    cd->setTransform(openvdb::math::Transform::createLinearTransform(0.5));
    const Imported imported = importGrids({density, cd});
    ASSERT_TRUE(imported.result) << imported.errorText();
    EXPECT_TRUE(imported.reported("vdb-color-transform"));
}

/// Red, green and blue as Blender's smoke has them: (1, 0, 0.5) at x = 0, green alone at x = 1, a blue tile
/// at 128.
openvdb::GridPtrVec channelGrids(const std::array<std::string, 3>& names) {
    const auto red = fogGrid(names[0], {Coord(0, 0, 0)});
    const auto green = fogGrid(names[1], {Coord(1, 0, 0)});
    const auto blue = fogGrid(names[2], {});
    blue->tree().setValueOn(Coord(0, 0, 0), 0.5f);
    blue->tree().addTile(2, Coord(128, 0, 0), 1.0f, true);
    return {red, green, blue};
}

TEST(ImportVdb, ColorsComeFromThreeFloatGrids) {
    using Names = std::array<std::string, 3>;
    for (const Names& names : {Names{"color_r", "color_g", "color_b"}, Names{"Cd.x", "Cd.y", "Cd.z"}}) {
        SCOPED_TRACE(names[0]);
        const auto density = fogGrid("density", {Coord(0, 0, 0), Coord(1, 0, 0), Coord(2, 0, 0)});
        density->tree().addTile(2, Coord(128, 0, 0), 1.0f, true);
        openvdb::GridPtrVec grids = channelGrids(names);
        grids.push_back(density);
        const Imported imported = importGrids(grids);
        ASSERT_TRUE(imported.result) << imported.errorText();
        const VoxelAsset& asset = *imported.result;
        ASSERT_EQ(asset.models.size(), 1u) << "the color grids are no models beside a density";
        EXPECT_EQ(asset.models[0].voxelCount(), 3u + (1u << 21));
        const auto colorAt = [&](glm::ivec3 v) {
            return glm::ivec3{asset.materials.at(*asset.models[0].at(v)).baseColor};
        };
        EXPECT_EQ(colorAt({0, 0, 0}), (glm::ivec3{255, 0, 188}));
        EXPECT_EQ(colorAt({1, 0, 0}), (glm::ivec3{0, 255, 0}));
        EXPECT_EQ(colorAt({2, 0, 0}), (glm::ivec3{0, 0, 0}));
        EXPECT_EQ(colorAt({200, 100, 100}), (glm::ivec3{0, 0, 255}));
        EXPECT_LT(asset.models[0].memoryBytes(), 1u << 20) << "the tile must stay one";
    }
}

TEST(ImportVdb, ThreeFloatGridsAloneStayModels) {
    const Imported imported = importGrids(channelGrids({"color_r", "color_g", "color_b"}));
    ASSERT_TRUE(imported.result) << imported.errorText();
    EXPECT_EQ(imported.result->models.size(), 3u);
    const Imported two =
        importGrids({fogGrid("color_r", {Coord(0, 0, 0)}), fogGrid("color_g", {Coord(0, 0, 0)})});
    EXPECT_EQ(two.result->models.size(), 2u) << "two are no colors";
}

TEST(ImportVdb, ColorChannelsOfDifferentTransformsAreReported) {
    openvdb::GridPtrVec grids = channelGrids({"color_r", "color_g", "color_b"});
    grids[1]->setTransform(openvdb::math::Transform::createLinearTransform(0.5));
    grids.push_back(fogGrid("density", {Coord(0, 0, 0)}));
    const Imported imported = importGrids(grids);
    ASSERT_TRUE(imported.result) << imported.errorText();
    EXPECT_TRUE(imported.reported("vdb-color-transform"));
    EXPECT_EQ(imported.result->materials.size(), 1u);
}

TEST(ImportVdb, EmptyColorGridsColorNothing) {
    const Imported imported = importGrids({fogGrid("density", {Coord(0, 0, 0)}), fogGrid("color_r", {}),
                                           fogGrid("color_g", {}), fogGrid("color_b", {})});
    ASSERT_TRUE(imported.result) << imported.errorText();
    EXPECT_TRUE(imported.reported("vdb-grid-empty"));
    const auto material = imported.result->models.at(0).at({0, 0, 0});
    EXPECT_EQ(imported.result->materials.at(material.value()).baseColor, (glm::u8vec4{255, 255, 255, 255}));
}

TEST(ImportVdb, MaterialTablesOfOurOwnAreRestored) {
    openvdb::initialize();
    const auto labelled = [](const std::string& table) {
        auto grid = openvdb::Int32Grid::create(0);
        grid->setName("material");
        grid->tree().setValueOn(Coord(0, 0, 0), 3);
        grid->tree().setValueOn(Coord(1, 0, 0), 9);
        grid->insertMeta("pfvox_grid", openvdb::StringMetadata("material"));
        grid->insertMeta("pfvox_materials", openvdb::StringMetadata(table));
        return importGrids({grid});
    };
    const Imported good = labelled("3 color=#01020304 type=glass ior=1.25 later=7 name=a b=c\\nd\n");
    ASSERT_TRUE(good.result) << good.errorText();
    const Material& restored = good.result->materials.at(good.result->models[0].at({0, 0, 0}).value());
    EXPECT_EQ(restored.baseColor, (glm::u8vec4{1, 2, 3, 4}));
    EXPECT_EQ(restored.type, MaterialType::Glass);
    EXPECT_EQ(restored.indexOfRefraction, 1.25f);
    EXPECT_EQ(restored.name, "a b=c\nd");
    EXPECT_EQ(good.result->materials.at(good.result->models[0].at({1, 0, 0}).value()).name, "9");
    for (const char* bad : {"x color=#01020304\n", "3 color=#0102\n", "3 type=stone\n", "3 ior=nan\n",
                            "3 ior=0.5\n", "3 emission=-5\n", "3 phase=2\n"}) {
        const Imported malformed = labelled(bad);
        ASSERT_TRUE(malformed.result) << malformed.errorText();
        EXPECT_TRUE(malformed.reported("vdb-materials-malformed")) << bad;
        EXPECT_EQ(malformed.result->models[0].voxelCount(), 2u);
    }
}

TEST(ImportVdb, GridsAreChosenByName) {
    const openvdb::GridPtrVec grids{fogGrid("a", {Coord(0, 0, 0)}),
                                    fogGrid("b", {Coord(1, 0, 0), Coord(2, 0, 0)}),
                                    fogGrid("b", {Coord(1, 0, 0), Coord(2, 0, 0), Coord(3, 0, 0)})};
    const Imported all = importGrids(grids);
    ASSERT_TRUE(all.result) << all.errorText();
    EXPECT_EQ(all.result->models.size(), 3u);
    EXPECT_EQ(all.result->instances.size(), 3u);
    EXPECT_TRUE(all.reported("vdb-several-grids"));
    ImportSettings settings;
    settings.vdb.grids = {"b[1]"};
    const Imported one = importGrids(grids, settings);
    ASSERT_TRUE(one.result) << one.errorText();
    ASSERT_EQ(one.result->models.size(), 1u);
    EXPECT_EQ(one.result->models[0].voxelCount(), 3u);
    settings.vdb.grids = {"b"};
    EXPECT_EQ(importGrids(grids, settings).result.value().models.size(), 2u);
    settings.vdb.grids = {"c"};
    const Imported none = importGrids(grids, settings);
    EXPECT_EQ(none.result.error().code, ErrorCode::BadReference);
    EXPECT_THAT(none.errorText(), testing::HasSubstr("\"a\", \"b[0]\", \"b[1]\""));
}

TEST(ImportVdb, SharedTreesAreOneModel) {
    auto parent = fogGrid("parent", {Coord(1, 2, 3)});
    auto child = openvdb::gridPtrCast<FloatGrid>(parent->copyGrid());  // shares the tree
    child->setName("child");
    child->setTransform(openvdb::math::Transform::createLinearTransform(2.0));
    const Imported imported = importGrids({parent, child});
    ASSERT_TRUE(imported.result) << imported.errorText();
    ASSERT_EQ(imported.result->models.size(), 1u);
    ASSERT_EQ(imported.result->instances.size(), 2u);
    EXPECT_EQ(imported.result->instances[1].worldFromModel[0].x, 2.0);
}

TEST(ImportVdb, StreamedFilesWithoutOffsetsAreRead) {
    const Imported imported = importAs(
        writeVdbStream({fogGrid("a", {Coord(0, 0, 0)}), fogGrid("b", {Coord(0, 0, 0), Coord(9, 9, 9)})}),
        "s.vdb");
    ASSERT_TRUE(imported.result) << imported.errorText();
    ASSERT_EQ(imported.result->models.size(), 2u);
    EXPECT_EQ(imported.result->models[1].voxelCount(), 2u);
}

TEST(ImportVdb, FarApartVoxelsAreCheap) {
    const Imported imported = importGrids({fogGrid("far", {Coord(-1'000'000'000), Coord(1'000'000'000)})});
    ASSERT_TRUE(imported.result) << imported.errorText();
    EXPECT_EQ(imported.result->models[0].voxelCount(), 2u);
    EXPECT_EQ(imported.result->models[0].bounds().size().x, 2'000'000'001);
    EXPECT_EQ(importGrids({fogGrid("out", {Coord(2'000'000'000)})}).result.error().code,
              ErrorCode::LimitExceeded);
}

TEST(ImportVdb, EmptyGridsAreNamed) {
    const Imported empty = importGrids({fogGrid("nothing", {})});
    ASSERT_FALSE(empty.result);
    EXPECT_EQ(empty.result.error().code, ErrorCode::NothingToConvert);
    EXPECT_THAT(empty.errorText(), testing::HasSubstr("grid \"nothing\" (Tree_float_5_4_3) is empty"));
    const Imported beside = importGrids({fogGrid("nothing", {}), fogGrid("something", {Coord(0, 0, 0)})});
    ASSERT_TRUE(beside.result) << beside.errorText();
    EXPECT_TRUE(beside.reported("vdb-grid-empty"));
    EXPECT_EQ(importGrids({}).result.error().code, ErrorCode::NothingToConvert);
}

TEST(ImportVdb, FrustumsAreRefusedWithTheRemedy) {
    auto grid = fogGrid("camera", {Coord(0, 0, 0)});
    grid->setTransform(openvdb::math::Transform::createFrustumTransform(
        openvdb::BBoxd(openvdb::Vec3d(0), openvdb::Vec3d(100)), 0.5, 10.0, 0.1));
    const Imported imported = importGrids({grid});
    ASSERT_FALSE(imported.result);
    EXPECT_EQ(imported.result.error().code, ErrorCode::UnsupportedFeature);
    EXPECT_THAT(imported.errorText(), testing::HasSubstr("frustum"));
    const Imported beside = importGrids({grid, fogGrid("box", {Coord(0, 0, 0)})});
    ASSERT_TRUE(beside.result) << beside.errorText();
    EXPECT_TRUE(beside.reported("vdb-grid-skipped"));
}

TEST(ImportVdb, VectorsThatAreNoColorsAreRefused) {
    openvdb::initialize();
    auto velocity = openvdb::Vec3SGrid::create();
    velocity->setName("vel");
    velocity->tree().setValueOn(Coord(0, 0, 0), openvdb::Vec3s(1.0f));
    EXPECT_THAT(importGrids({velocity}).errorText(), testing::HasSubstr("holds vectors"));
}

TEST(ImportVdb, LargeTiledFogIsFast) {
    auto grid = fogGrid("fog", {});
    for (int x = 0; x < 8; ++x)
        for (int y = 0; y < 4; ++y)
            for (int z = 0; z < 4; ++z) grid->tree().addTile(2, Coord(x * 128, y * 128, z * 128), 1.0f, true);
    const Bytes file = writeVdb({grid});
    const auto start = std::chrono::steady_clock::now();
    const Imported imported = importAs(file, "fog.vdb");
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    ASSERT_TRUE(imported.result) << imported.errorText();
    EXPECT_EQ(imported.result->models[0].voxelCount(), 128ull << 21);
    EXPECT_LT(seconds, 1.0);
}

// --- The corpus, each grid against OpenVDB's own accessors ---

template <class GridT>
bool countInto(const openvdb::GridBase& grid, std::uint64_t& count) {
    if (!grid.isType<GridT>()) return false;
    const auto& typed = static_cast<const GridT&>(grid);
    count = countSolid(typed, grid.getGridClass() == openvdb::GRID_LEVEL_SET);
    return true;
}

/// Solid voxels by grid name, of the grids that can be models.
std::map<std::string, std::uint64_t> countFile(const std::filesystem::path& path) {
    openvdb::initialize();
    std::map<std::string, std::uint64_t> counts;
    openvdb::io::File file(path.string());
    file.open(/*delayLoad=*/false);
    for (auto name = file.beginName(); name != file.endName(); ++name) {
        const auto grid = file.readGrid(name.gridName());
        std::uint64_t count = 0;
        if (countInto<FloatGrid>(*grid, count) || countInto<openvdb::DoubleGrid>(*grid, count)) {
            if (count != 0) counts[name.gridName()] = count;
        }
    }
    return counts;
}

TEST(ImportVdb, CorpusFilesHaveTheVoxelsThatOpenVdbSees) {
    const auto files = corpusFiles("vdb", ".vdb");
    if (files.empty()) GTEST_SKIP() << "corpus/vdb is absent";
    int compared = 0;
    for (const auto& path : files) {
        SCOPED_TRACE(path.filename());
        if (path.parent_path().filename() == "damaged") continue;
        const auto expected = countFile(path);
        if (expected.empty()) continue;
        const Imported imported = importAs(readBytes(path), path.string());
        ASSERT_TRUE(imported.result) << imported.errorText();
        std::map<std::string, std::uint64_t> found;
        for (const Instance& instance : imported.result->instances) {
            found[instance.name] = imported.result->models[instance.model].voxelCount();
        }
        EXPECT_EQ(found, expected);
        ++compared;
    }
    EXPECT_GT(compared, 0);
}

TEST(ImportVdb, CorpusColorGridsAloneAreModels) {
    PFVOX_NEEDS_CORPUS("vdb/sphereCd.vdb");
    const auto root = std::filesystem::path(PFVOX_CORPUS_DIR) / "vdb";
    const Imported sphere = importAs(readBytes(root / "sphereCd.vdb"), "sphereCd.vdb");
    ASSERT_TRUE(sphere.result) << sphere.errorText();
    EXPECT_EQ(sphere.result->models[0].voxelCount(), 9047u);
    const Imported cubes = importAs(readBytes(root / "two_cubes.vdb"), "two_cubes.vdb");
    ASSERT_TRUE(cubes.result) << cubes.errorText();
    EXPECT_EQ(cubes.result->models[0].voxelCount(), 1671u);
    const Imported colored = importAs(readBytes(root / "made" / "density_Cd.vdb"), "density_Cd.vdb");
    ASSERT_TRUE(colored.result) << colored.errorText();
    ASSERT_EQ(colored.result->models.size(), 1u);
    EXPECT_EQ(colored.result->models[0].voxelCount(), 512u);
    EXPECT_GT(colored.result->materials.size(), 100u);
}

TEST(ImportVdb, CorpusPointGridsAreRefusedByName) {
    PFVOX_NEEDS_CORPUS("vdb/pointgrid.vdb");
    const auto root = std::filesystem::path(PFVOX_CORPUS_DIR) / "vdb";
    const Imported points = importAs(readBytes(root / "pointgrid.vdb"), "pointgrid.vdb");
    ASSERT_FALSE(points.result);
    EXPECT_EQ(points.result.error().code, ErrorCode::UnsupportedFeature);
    EXPECT_THAT(points.errorText(),
                testing::HasSubstr("grid \"points\" (Tree_ptdataidx32_5_4_3) holds points"));
}

}  // namespace
}  // namespace pfvox::test
