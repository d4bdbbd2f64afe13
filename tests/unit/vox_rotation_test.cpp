// Rotations and placement of MagicaVoxel models: against positions worked out by hand, and all 48 against the
// independent reader.
#include <gmock/gmock.h>

#include <set>

#include "support/import_bytes.hpp"
#include "support/independent_vox_reader.hpp"
#include "support/vox_asset_cells.hpp"
#include "support/vox_writer.hpp"

namespace pfvox {
namespace {

using test::Cell;
using test::ImportRun;
using test::VoxDict;
using test::VoxVoxel;
using test::VoxWriter;

const std::set<int> kProper{2,  4,  9,  17, 22, 24, 33, 38,  40,  50,  52,  57,
                            65, 70, 72, 82, 84, 89, 98, 100, 105, 113, 118, 120};

/// Corners and an inner voxel, a color each, so that no symmetry hides a mistake.
const std::vector<VoxVoxel> kAsymmetric{{0, 0, 0, 1}, {3, 0, 0, 2}, {0, 2, 0, 3},
                                        {0, 0, 1, 4}, {3, 2, 1, 5}, {1, 1, 0, 6}};

std::string placed(const std::array<std::int32_t, 3>& size, const std::vector<VoxVoxel>& voxels,
                   const VoxDict& frame) {
    return VoxWriter().model(size, voxels).transform({.frames = {frame}}).shape({}).finish();
}

/// World cells without colors, in pfvox axes.
std::vector<Cell> cellsOf(const Result<VoxelAsset>& asset) {
    std::vector<Cell> cells;
    for (const Instance& instance : asset->instances) {
        for (const auto& [cell, look] : test::worldCellsOf(*asset, instance)) cells.push_back(cell);
    }
    return cells;
}

TEST(VoxRotation, ExactlyTheFortyEightSignedPermutationsAreAccepted) {
    int accepted = 0;
    for (int byte = 0; byte < 256; ++byte) {
        ImportRun run;
        const auto asset = run(placed({4, 3, 2}, kAsymmetric, {{"_r", std::to_string(byte)}}));
        if (!asset) {
            EXPECT_EQ(asset.error().code, ErrorCode::BadValue);
            EXPECT_THAT(describe(asset.error()), testing::HasSubstr("chunk nTRN @0x"));
            EXPECT_THAT(describe(asset.error()), testing::HasSubstr("node 0: _r"));
            EXPECT_FALSE(kProper.contains(byte)) << byte;
            continue;
        }
        ++accepted;
        const glm::dmat3 linear{asset->instances[0].worldFromModel};
        EXPECT_EQ(glm::determinant(linear) > 0, kProper.contains(byte)) << byte;
    }
    EXPECT_EQ(accepted, 48);
}

TEST(VoxRotation, AllFortyEightPlaceVoxelsByTheIntegerFormula) {
    for (const std::array<std::int32_t, 3>& size :
         {std::array{4, 3, 2}, std::array{5, 3, 3}, std::array{4, 4, 2}}) {
        for (int byte = 0; byte < 128; ++byte) {
            ImportRun run;
            const std::string bytes =
                placed(size, kAsymmetric, {{"_r", std::to_string(byte)}, {"_t", "7 -11 13"}});
            const auto asset = run(bytes);
            if (!asset) continue;
            const auto expected = test::IndependentVoxReader(bytes).instances();
            EXPECT_TRUE(test::worldCellsOf(*asset, asset->instances[0]) == test::worldCellsOf(expected[0]))
                << byte;
        }
    }
}

// R = [0 1 0; 0 0 -1; -1 0 0]. The pivot of 4 x 3 x 2 is (2, 1, 1). Voxel (0, 0, 0) has its center at
// (-1.5, -0.5, -0.5) from there, which turns into (-0.5, 0.5, 1.5): cell (-1, 0, 1). Voxel (3, 2, 1) has
// (1.5, 1.5, 0.5), turned (1.5, -0.5, -1.5): cell (1, -1, -2). Then t, then (x, z, -y - 1).
TEST(VoxRotation, Byte105ByHand) {
    ImportRun run;
    const auto asset =
        run(placed({4, 3, 2}, {{0, 0, 0, 1}, {3, 2, 1, 1}}, {{"_r", "105"}, {"_t", "10 20 30"}}));
    ASSERT_TRUE(asset) << describe(asset.error());
    EXPECT_THAT(cellsOf(asset), testing::UnorderedElementsAre(Cell{9, 31, -21}, Cell{11, 28, -20}));
}

TEST(VoxRotation, MissingMeansIdentity) {
    ImportRun run;
    EXPECT_THAT(cellsOf(run(placed({4, 3, 2}, {{0, 0, 0, 1}}, {}))), testing::ElementsAre(Cell{-2, -1, 0}));
    EXPECT_THAT(cellsOf(run(placed({4, 3, 2}, {{0, 0, 0, 1}}, {{"_r", "4"}}))),
                testing::ElementsAre(Cell{-2, -1, 0}));
}

// An even edge mirrors onto itself; an odd one has its pivot in the voxel right of the middle's start and
// moves by one.
TEST(VoxRotation, MirrorsOfEvenAndOddEdges) {
    ImportRun run;
    const std::vector<VoxVoxel> ends4{{0, 0, 0, 1}, {3, 0, 0, 1}};
    const std::vector<VoxVoxel> ends3{{0, 0, 0, 1}, {2, 0, 0, 1}};
    EXPECT_THAT(cellsOf(run(placed({4, 1, 1}, ends4, {{"_r", "20"}}))),
                testing::ElementsAre(Cell{-2, 0, -1}, Cell{1, 0, -1}));
    EXPECT_THAT(cellsOf(run(placed({3, 1, 1}, ends3, {{"_r", "4"}}))),
                testing::ElementsAre(Cell{-1, 0, -1}, Cell{1, 0, -1}));
    EXPECT_THAT(cellsOf(run(placed({3, 1, 1}, ends3, {{"_r", "20"}}))),
                testing::ElementsAre(Cell{-2, 0, -1}, Cell{0, 0, -1}));
}

// The parent turns a quarter about z (x to y) and moves by 10 along x; the child moves by 5 along its x,
// which is the world's y. The one voxel's center (0.5, 0.5, 0.5) turns into (-0.5, 0.5, 0.5).
TEST(VoxRotation, NestedTransformsByHand) {
    const std::string bytes =
        VoxWriter()
            .model({1, 1, 1}, {{0, 0, 0, 1}})
            .transform({.id = 0, .child = 1, .frames = {{{"_r", "17"}, {"_t", "10 0 0"}}}})
            .group(1, {2})
            .transform({.id = 2, .child = 3, .frames = {{{"_t", "5 0 0"}}}})
            .shape({.id = 3})
            .finish();
    ImportRun run;
    EXPECT_THAT(cellsOf(run(bytes)), testing::ElementsAre(Cell{9, 0, -6}));
}

TEST(VoxRotation, ModelVoxelsLieInTheModelsBox) {
    ImportRun run;
    const auto asset = run(placed({4, 3, 2}, {{1, 0, 1, 7}}, {{"_r", "70"}}));
    ASSERT_TRUE(asset);
    EXPECT_EQ(asset->models[0].at({1, 1, 2}), MaterialIndex{6});  // z' = 3 - 1 - 0
}

TEST(VoxRotation, VoxelSizeScalesTheWorld) {
    ImportRun run;
    run.settings.voxelSizeMetres = 0.25;
    const auto asset = run(placed({1, 1, 1}, {{0, 0, 0, 1}}, {{"_t", "4 8 12"}}));
    ASSERT_TRUE(asset);
    EXPECT_EQ(asset->source.voxelSizeMetres, 0.25);
    const glm::dvec3 corner = asset->instances[0].worldFromModel * glm::dvec4(0, 0, 0, 1);
    EXPECT_EQ(corner, (glm::dvec3{1.0, 3.0, -2.25}));
}

TEST(VoxRotation, TranslationsThatAreNoneAreRefused) {
    for (const char* t : {"1 2", "1 2 3 4", "1 2 x", "1.5 0 0", "", "99999999999 0 0"}) {
        ImportRun run;
        const auto asset = run(placed({1, 1, 1}, {{0, 0, 0, 1}}, {{"_t", t}}));
        ASSERT_FALSE(asset) << t;
        EXPECT_EQ(asset.error().code, ErrorCode::BadValue) << t;
    }
}

}  // namespace
}  // namespace pfvox
