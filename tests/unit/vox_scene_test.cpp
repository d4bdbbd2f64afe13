// Models, instances, layers and frames of MagicaVoxel files.
#include <gmock/gmock.h>

#include "support/import_bytes.hpp"
#include "support/vox_writer.hpp"

namespace pfvox {
namespace {

using test::ImportRun;
using test::voxBytes;
using test::voxDict;
using test::voxInts;
using test::voxString;
using test::VoxWriter;

/// Models of 1, 2, 3 ... voxels in a row.
VoxWriter models(int count) {
    VoxWriter writer;
    for (int m = 1; m <= count; ++m) {
        std::vector<test::VoxVoxel> row;
        for (int x = 0; x < m; ++x) row.push_back({static_cast<std::uint8_t>(x), 0, 0, 1});
        writer.model({count, 1, 1}, row);
    }
    return writer;
}

/// A root, a group and for each entry a transform with its shape: ids 2, 3, then 4, 5, ...
VoxWriter scene(VoxWriter writer, const std::vector<VoxWriter::Transform>& children,
                const std::vector<int>& modelIds) {
    std::vector<std::int32_t> ids;
    for (std::size_t i = 0; i < children.size(); ++i) ids.push_back(static_cast<std::int32_t>(2 + 2 * i));
    writer.transform({.id = 0, .child = 1}).group(1, ids);
    for (std::size_t i = 0; i < children.size(); ++i) {
        VoxWriter::Transform transform = children[i];
        transform.id = ids[i];
        transform.child = ids[i] + 1;
        writer.transform(transform);
        VoxWriter::Shape shape;
        shape.id = ids[i] + 1;
        shape.models = {{modelIds[i], {}}};
        writer.shape(shape);
    }
    return writer;
}

std::vector<std::uint64_t> voxelCounts(const VoxelAsset& asset) {
    std::vector<std::uint64_t> counts;
    for (const VoxelModel& model : asset.models) counts.push_back(model.voxelCount());
    return counts;
}

using testing::ElementsAre;
using testing::HasSubstr;

TEST(VoxScene, FileWithoutGraphHasItsMiddleInTheOrigin) {
    ImportRun run;
    const auto asset = run(VoxWriter().model({3, 4, 7}, {{0, 0, 0, 1}}).finish());
    ASSERT_TRUE(asset);
    ASSERT_EQ(asset->instances.size(), 1u);
    const Affine& placed = asset->instances[0].worldFromModel;
    // MagicaVoxel's pivot is the middle voxel (1, 2, 3); its y points away from where our z points to.
    EXPECT_EQ(placed[3], (glm::dvec3{-1, -3, -2} * kDefaultVoxelSizeMetres));
    EXPECT_EQ(placed[0], (glm::dvec3{kDefaultVoxelSizeMetres, 0, 0}));
    // As with a graph whose transform moves nothing.
    const auto inGraph = ImportRun()(VoxWriter()
                                         .model({3, 4, 7}, {{0, 0, 0, 1}})
                                         .transform({.id = 0, .child = 1})
                                         .shape({.id = 1})
                                         .finish());
    ASSERT_TRUE(inGraph);
    EXPECT_EQ(inGraph->instances[0].worldFromModel, placed);
    EXPECT_TRUE(asset->models[0].at({0, 0, 3}));
    EXPECT_EQ(asset->source.format, "vox");
}

TEST(VoxScene, CornerOfASmallModelWithoutGraph) {
    ImportRun run;
    const auto asset = run(VoxWriter().model({3, 3, 3}, {{0, 0, 0, 1}}).finish());
    ASSERT_TRUE(asset);
    EXPECT_TRUE(asset->models[0].at({0, 0, 2}));
    EXPECT_EQ(asset->source.format, "vox");
}

TEST(VoxScene, ModelsWithoutGraphAreFrames) {
    const std::string bytes = VoxWriter(models(3)).chunk("PACK", voxInts({3})).finish();
    ImportRun run;
    EXPECT_THAT(voxelCounts(*run(bytes)), ElementsAre(1));
    EXPECT_TRUE(run.reported("vox-frames"));
    run.settings.frame = 2;
    EXPECT_THAT(voxelCounts(*run(bytes)), ElementsAre(3));
    run.settings.frame = 3;
    const auto beyond = run(bytes);
    ASSERT_FALSE(beyond);
    EXPECT_EQ(beyond.error().code, ErrorCode::BadReference);
    EXPECT_THAT(beyond.error().message, HasSubstr("0 to 2"));
    run.settings.frame = -1;
    EXPECT_FALSE(run(bytes));
}

TEST(VoxScene, InstancesShareTheirModel) {
    ImportRun run;
    const auto asset = run(scene(models(2), {{}, {}, {}}, {1, 0, 1}).finish());
    ASSERT_TRUE(asset);
    EXPECT_THAT(voxelCounts(*asset), ElementsAre(1, 2));
    ASSERT_EQ(asset->instances.size(), 3u);
    EXPECT_EQ(asset->instances[0].model, 1u);
    EXPECT_EQ(asset->instances[1].model, 0u);
}

TEST(VoxScene, NodesMayHaveSeveralParents) {
    ImportRun run;
    const auto asset = run(models(1)
                               .transform({.id = 0, .child = 1})
                               .group(1, {2, 3})
                               .transform({.id = 2, .child = 4, .frames = {{{"_t", "10 0 0"}}}})
                               .transform({.id = 3, .child = 4, .frames = {{{"_t", "20 0 0"}}}})
                               .shape({.id = 4})
                               .finish());
    ASSERT_TRUE(asset) << describe(asset.error());
    EXPECT_EQ(asset->models.size(), 1u);
    ASSERT_EQ(asset->instances.size(), 2u);
    EXPECT_NE(asset->instances[0].worldFromModel, asset->instances[1].worldFromModel);
}

TEST(VoxScene, TransformMayFollowTransform) {
    ImportRun run;
    const auto asset = run(models(1)
                               .transform({.id = 0, .child = 7, .frames = {{{"_t", "1 0 0"}}}})
                               .transform({.id = 7, .child = 9, .frames = {{{"_t", "2 0 0"}}}})
                               .shape({.id = 9})
                               .finish());
    ASSERT_TRUE(asset);
    EXPECT_DOUBLE_EQ(asset->instances[0].worldFromModel[3].x, 3 * kDefaultVoxelSizeMetres);
}

TEST(VoxScene, RootThatIsItsOwnChildGivesEveryModelOnce) {
    ImportRun run;
    const auto asset = run(models(2).transform({.id = 0, .child = 0}).finish());
    ASSERT_TRUE(asset) << describe(asset.error());
    EXPECT_THAT(voxelCounts(*asset), ElementsAre(1, 2));
    ASSERT_EQ(asset->instances.size(), 2u);
    for (const Instance& instance : asset->instances)
        EXPECT_EQ(instance.worldFromModel[3], (glm::dvec3{-1, 0, -1} * kDefaultVoxelSizeMetres))
            << "the middle of 2 x 1 x 1";
    EXPECT_TRUE(run.reported("vox-graph-without-shapes"));
}

TEST(VoxScene, NamesComeFromTheGraph) {
    ImportRun run;
    VoxWriter writer = models(1);
    writer.transform({.id = 0, .child = 1, .attributes = {{"_name", "world"}}}).group(1, {2, 4});
    writer.transform({.id = 2, .child = 3, .attributes = {{"_name", "door"}}}).shape({.id = 3});
    writer.transform({.id = 4, .child = 5}).shape({.id = 5});
    const auto asset = run(writer.finish());
    ASSERT_TRUE(asset);
    EXPECT_EQ(asset->models[0].name, "door");
    EXPECT_EQ(asset->instances[0].name, "door");
    EXPECT_EQ(asset->instances[1].name, "world");
}

TEST(VoxScene, HiddenNodesAndLayersAreLeftOutUnlessWanted) {
    VoxWriter writer =
        scene(models(4), {{.attributes = {{"_hidden", "1"}}}, {.layer = 3}, {.layer = 4}, {.layer = 5}},
              {0, 1, 2, 3});
    writer.layer(3, {{"_hidden", "1"}, {"_name", "cellar"}})
        .layer(4, {{"_visible", "0"}})
        .layer(5, {{"_name", "hall"}});
    ImportRun run;
    const auto visible = run(writer.finish());
    ASSERT_TRUE(visible);
    EXPECT_THAT(voxelCounts(*visible), ElementsAre(4));
    EXPECT_THAT(run.messageOf("vox-hidden-dropped"), HasSubstr("3 hidden"));
    EXPECT_THAT(run.messageOf("vox-unused-models"), HasSubstr("3 of 4"));
    ASSERT_EQ(visible->layers.size(), 3u);
    EXPECT_EQ(visible->layers[0], (Layer{.name = "cellar", .hidden = true}));
    EXPECT_EQ(visible->instances[0].layer, 2);

    run.settings.includeHidden = true;
    const auto all = run(writer.finish());
    ASSERT_TRUE(all);
    EXPECT_THAT(voxelCounts(*all), ElementsAre(1, 2, 3, 4));
    EXPECT_EQ(all->instances.size(), 4u);
    EXPECT_FALSE(all->instances[0].hidden);
    EXPECT_FALSE(all->layers[0].hidden);
}

TEST(VoxScene, HiddenGroupHidesWhatIsBelow) {
    ImportRun run;
    const auto asset = run(models(1)
                               .transform({.id = 0, .child = 1})
                               .group(1, {2}, {{"_hidden", "1"}})
                               .shape({.id = 2})
                               .finish());
    ASSERT_FALSE(asset);
    EXPECT_EQ(asset.error().code, ErrorCode::NothingToConvert);
    EXPECT_THAT(asset.error().message, HasSubstr("hidden"));
}

TEST(VoxScene, UnusedModelsAreKeptWithHiddenOnes) {
    ImportRun run;
    const std::string bytes = scene(models(3), {{}}, {1}).finish();
    EXPECT_THAT(voxelCounts(*run(bytes)), ElementsAre(2));
    EXPECT_TRUE(run.reported("vox-unused-models"));
    run.settings.includeHidden = true;
    const auto all = run(bytes);
    EXPECT_THAT(voxelCounts(*all), ElementsAre(1, 2, 3));
    ASSERT_EQ(all->instances.size(), 1u);
    EXPECT_EQ(all->instances[0].model, 1u);
}

TEST(VoxScene, KeysHoldUntilTheNextOne) {
    VoxWriter writer = models(3);
    writer.transform({.frames = {{{"_t", "1 0 0"}}, {{"_f", "10"}, {"_t", "2 0 0"}}}});
    writer.shape({.models = {{0, {{"_f", "0"}}}, {2, {{"_f", "5"}}}, {1, {{"_f", "20"}}}}});
    const std::string bytes = writer.finish();
    struct Step {
        int frame;
        std::uint64_t voxels;
        double x;
    };
    for (const Step& step : {Step{0, 1, 1}, Step{4, 1, 1}, Step{5, 3, 1}, Step{9, 3, 1}, Step{10, 3, 2},
                             Step{20, 2, 2}, Step{1000, 2, 2}}) {
        ImportRun run;
        run.settings.frame = step.frame;
        const auto asset = run(bytes);
        ASSERT_TRUE(asset) << step.frame;
        EXPECT_THAT(voxelCounts(*asset), ElementsAre(step.voxels)) << step.frame;
        // The pivot of an edge of 3 is 1.
        EXPECT_DOUBLE_EQ(asset->instances[0].worldFromModel[3].x, (step.x - 1) * kDefaultVoxelSizeMetres)
            << step.frame;
    }
}

TEST(VoxScene, LoopedKeysRepeat) {
    VoxWriter writer = models(2);
    writer.transform({}).shape(
        {.models = {{0, {{"_f", "0"}}}, {1, {{"_f", "2"}}}}, .attributes = {{"_loop", "1"}}});
    for (const auto& [frame, voxels] :
         std::vector<std::pair<int, std::uint64_t>>{{2, 2}, {3, 1}, {4, 1}, {5, 2}}) {
        ImportRun run;
        run.settings.frame = frame;
        EXPECT_THAT(voxelCounts(*run(writer.finish())), ElementsAre(voxels)) << frame;
    }
}

TEST(VoxScene, MergeKeepsTheLastVoxelAndCountsTheOthers) {
    VoxWriter writer;
    writer.model({2, 1, 1}, {{0, 0, 0, 10}, {1, 0, 0, 10}}).model({1, 1, 1}, {{0, 0, 0, 20}});
    const std::string bytes =
        scene(writer, {{.frames = {{{"_t", "1 0 0"}}}}, {.frames = {{{"_t", "1 0 0"}}}}}, {0, 1}).finish();
    ImportRun run;
    run.settings.merge = true;
    const auto asset = run(bytes);
    ASSERT_TRUE(asset);
    EXPECT_THAT(voxelCounts(*asset), ElementsAre(2));
    EXPECT_EQ(asset->models[0].at({0, 0, -1}), MaterialIndex{9});
    EXPECT_EQ(asset->models[0].at({1, 0, -1}), MaterialIndex{19});
    EXPECT_THAT(run.messageOf("vox-overlap"), HasSubstr("1 voxels"));
    ASSERT_EQ(asset->instances.size(), 1u);
    EXPECT_EQ(asset->instances[0].worldFromModel, Affine{kDefaultVoxelSizeMetres});
}

TEST(VoxScene, SuspiciousVoxelsAreDroppedAndReported) {
    ImportRun run;
    const auto asset =
        run(VoxWriter()
                .model({2, 2, 2}, {{0, 0, 0, 1}, {2, 0, 0, 1}, {0, 0, 5, 1}, {1, 1, 1, 0}, {0, 0, 0, 7}})
                .finish());
    ASSERT_TRUE(asset);
    EXPECT_THAT(voxelCounts(*asset), ElementsAre(1));
    EXPECT_EQ(asset->models[0].at({0, 0, 1}), MaterialIndex{6});
    EXPECT_THAT(run.messageOf("vox-voxels-outside"), HasSubstr("2 voxels"));
    EXPECT_THAT(run.messageOf("vox-voxels-without-color"), HasSubstr("1 voxels"));
    EXPECT_THAT(run.messageOf("vox-duplicate-voxels"), HasSubstr("1 voxels"));
}

TEST(VoxScene, EmptyModelsKeepTheirId) {
    ImportRun run;
    VoxWriter writer;
    writer.model({0, 0, 0}, {}).model({1, 1, 1}, {{0, 0, 0, 1}});
    const auto asset = run(scene(writer, {{}, {}}, {0, 1}).finish());
    ASSERT_TRUE(asset) << describe(asset.error());
    EXPECT_THAT(voxelCounts(*asset), ElementsAre(0, 1));
    EXPECT_THAT(run.messageOf("empty-models"), HasSubstr("1 of 2 models"));
}

TEST(VoxScene, AFileOfEmptyModelsIsSaid) {
    ImportRun run;
    ASSERT_TRUE(run(VoxWriter().model({2, 2, 2}, {}).finish()));
    EXPECT_THAT(run.messageOf("empty-models"), HasSubstr("no model of the file has a voxel"));
}

TEST(VoxScene, AlphaOfColorsInUseIsSaid) {
    std::string colors(1024, '\xff');
    colors[4 * 1 + 3] = '\x80';  // index 2
    colors[4 * 6 + 3] = '\0';    // index 7, which no voxel has
    ImportRun run;
    ASSERT_TRUE(
        run(VoxWriter().model({2, 1, 1}, {{0, 0, 0, 1}, {1, 0, 0, 2}}).chunk("RGBA", colors).finish()));
    EXPECT_THAT(run.messageOf("vox-palette-alpha"), HasSubstr("1 of the colors used"));
}

TEST(VoxScene, NamesInOtherCodePagesBecomeUtf8) {
    VoxWriter writer = models(1);
    writer.transform({.id = 0, .child = 1, .attributes = {{"_name", "Fen\xeatre \x93x\x94"}}})
        .shape({.id = 1});
    writer.chunk("NOTE", voxInts({1}) + voxString("\xff"));
    ImportRun run;
    const auto asset = run(writer.finish());
    ASSERT_TRUE(asset) << describe(asset.error());
    EXPECT_EQ(asset->instances[0].name, "Fenêtre “x”");
    EXPECT_EQ(asset->models[0].name, "Fenêtre “x”");
    EXPECT_THAT(asset->source.notes, ElementsAre(HasSubstr("ÿ")));
    EXPECT_THAT(run.messageOf("name-encoding"), HasSubstr("3 names"));
}

TEST(VoxScene, NamesInUtf8StayAsTheyAre) {
    VoxWriter writer = models(1);
    writer.transform({.id = 0, .child = 1, .attributes = {{"_name", "🏠 dům"}}}).shape({.id = 1});
    ImportRun run;
    const auto asset = run(writer.finish());
    ASSERT_TRUE(asset);
    EXPECT_EQ(asset->instances[0].name, "🏠 dům");
    EXPECT_FALSE(run.reported("name-encoding"));
}

TEST(VoxScene, EdgesBeyondAByteMoveThePivotOnly) {
    ImportRun run;
    const auto asset = run(VoxWriter().model({300, 300, 300}, {{255, 0, 255, 1}, {0, 255, 0, 2}}).finish());
    ASSERT_TRUE(asset);
    EXPECT_TRUE(run.reported("vox-size-too-large"));
    EXPECT_EQ(asset->models[0].at({255, 255, 299}), MaterialIndex{0});
    EXPECT_EQ(asset->models[0].at({0, 0, 44}), MaterialIndex{1});
}

TEST(VoxScene, UnknownAndSkippedChunks) {
    ImportRun run;
    ASSERT_TRUE(run(models(1)
                        .chunk("ABCD", "xyz")
                        .chunk("ABCD", "")
                        .chunk("rOBJ", voxDict({{"_type", "_inf"}}))
                        .finish()));
    ASSERT_EQ(run.diagnostics.entries().size(), 1u);
    EXPECT_THAT(run.messageOf("vox-unknown-chunks"), HasSubstr("ABCD (2)"));
}

TEST(VoxScene, ChildrenOfChunksAreSteppedOver) {
    ImportRun run;
    const std::string chunks = test::voxChunk("rOBJ", voxDict({}), "12345") +
                               test::voxChunk("SIZE", voxInts({1, 1, 1})) +
                               test::voxChunk("XYZI", voxInts({1, 0x01000000}));
    EXPECT_TRUE(run("VOX " + voxBytes(150) + test::voxChunk("MAIN", "own content", chunks)));
}

/// As the crate dot_vox 4.1 to 5.1 wrote files of several models: PACK claims a size of children that it has
/// not.
std::string packedWithChildren(int count, std::int32_t childrenBytes) {
    std::string chunks = "PACK" + voxInts({4, childrenBytes, count});
    for (int m = 0; m < count; ++m)
        chunks +=
            test::voxChunk("SIZE", voxInts({2, 1, 1})) + test::voxChunk("XYZI", voxInts({1, 0x01000000}));
    return chunks;
}

TEST(VoxScene, ChunksAreBelievedMoreThanTheSizeOfPack) {
    // Into the middle of a chunk, and over two whole models.
    for (const std::int32_t claimed : {12, 44, 2 * (24 + 20), 0x7fffffff}) {
        ImportRun run;
        run.settings.includeHidden = true;
        const auto asset =
            run("VOX " + voxBytes(150) + test::voxChunk("MAIN", "", packedWithChildren(3, claimed)));
        ASSERT_TRUE(asset) << claimed << ": " << describe(asset.error());
        EXPECT_THAT(voxelCounts(*asset), ElementsAre(1, 1, 1)) << claimed;
        EXPECT_THAT(run.messageOf("vox-container-size"), HasSubstr("PACK")) << claimed;
    }
}

TEST(VoxScene, ChunksAreBelievedMoreThanTheSizeOfMain) {
    const std::string chunks =
        test::voxChunk("SIZE", voxInts({2, 1, 1})) + test::voxChunk("XYZI", voxInts({1, 0x01000000}));
    const auto size = static_cast<std::int32_t>(chunks.size());
    for (const auto& [content, children] : std::vector<std::pair<std::int32_t, std::int32_t>>{
             {0, 0}, {0, 24}, {0, 30}, {0, size + 1000}, {0, 0x7fffffff}, {size, 0}}) {
        ImportRun run;
        const auto asset = run("VOX " + voxBytes(150) + "MAIN" + voxInts({content, children}) + chunks);
        ASSERT_TRUE(asset) << children << ": " << describe(asset.error());
        EXPECT_THAT(voxelCounts(*asset), ElementsAre(1)) << children;
        EXPECT_TRUE(run.reported("vox-container-size")) << content << " " << children;
    }
}

TEST(VoxScene, VersionsAndTrailingBytes) {
    for (const int version : {150, 200}) {
        ImportRun run;
        ASSERT_TRUE(run(models(1).finish(version)));
        EXPECT_TRUE(run.diagnostics.entries().empty());
    }
    ImportRun run;
    ASSERT_TRUE(run(models(1).finish(151) + "tail"));
    EXPECT_TRUE(run.reported("vox-version"));
    EXPECT_THAT(run.messageOf("vox-trailing-bytes"), HasSubstr("4 bytes"));
}

TEST(VoxScene, LastOfDuplicateChunksCounts) {
    ImportRun run;
    VoxWriter writer = models(2);
    writer.transform({}).shape({.models = {{0, {}}}}).shape({.models = {{1, {}}}});
    const auto asset = run(writer.finish());
    EXPECT_THAT(voxelCounts(*asset), ElementsAre(2));
    EXPECT_THAT(run.messageOf("vox-duplicate-chunk"), HasSubstr("node 1"));
}

TEST(VoxScene, CamerasAndNotes) {
    VoxWriter writer = models(1);
    writer.chunk(
        "rCAM", voxInts({0}) +
                    voxDict({{"_mode", "pers"}, {"_focus", "0 0 0"}, {"_angle", "0 0 0"}, {"_radius", "0"}}));
    writer.chunk(
        "rCAM", voxInts({1}) +
                    voxDict({{"_focus", "10 20 30"}, {"_angle", "0 0 0"}, {"_radius", "5"}, {"_fov", "60"}}));
    writer.chunk("NOTE", voxInts({2}) + voxString("") + voxString("skin"));
    writer.chunk("META", voxDict({{"_anim_range", "0 30"}}));
    ImportRun run;
    const auto asset = run(writer.finish());
    ASSERT_TRUE(asset) << describe(asset.error());
    EXPECT_THAT(asset->source.notes, ElementsAre("color row 1: skin", "_anim_range: 0 30"));
    ASSERT_EQ(asset->cameras.size(), 1u);
    EXPECT_DOUBLE_EQ(asset->cameras[0].fovYDegrees, 60.0);
    EXPECT_NEAR(glm::distance(asset->cameras[0].target, glm::dvec3(1.0, 3.0, -2.0)), 0.0, 1e-9);
    EXPECT_NEAR(glm::distance(asset->cameras[0].position, asset->cameras[0].target), 0.5, 1e-9);
}

}  // namespace
}  // namespace pfvox
