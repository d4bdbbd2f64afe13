// Merging sources other than .vox: several instances become one model that shows the same world, the last one
// on top.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <pfvox/export.hpp>
#include <random>

#include "support/corpus.hpp"
#include "support/import_helpers.hpp"
#include "support/voxel_models.hpp"

namespace pfvox::test {
namespace {

constexpr double kVoxel = 0.125;

/// One of the 48 turns and mirrors, and a move by whole voxels.
Affine randomGridTransform(std::mt19937& random) {
    std::array<int, 3> axes{0, 1, 2};
    std::ranges::shuffle(axes, random);
    Affine affine{0.0};
    for (int column = 0; column < 3; ++column) {
        affine[column][axes[static_cast<std::size_t>(column)]] = random() % 2 == 0 ? kVoxel : -kVoxel;
        affine[3][column] = kVoxel * (static_cast<int>(random() % 41) - 20);
    }
    return affine;
}

struct World {
    std::map<std::array<int, 3>, Material> cells;
    std::uint64_t replaced = 0;
};

/// The world cell by cell, from the centers of voxels; later instances replace earlier ones.
World worldOf(const VoxelAsset& asset) {
    World world;
    for (const Instance& instance : asset.instances) {
        const VoxelModel& model = asset.models[instance.model];
        for (const Voxel& v : voxelsIn(model, model.bounds())) {
            const glm::dvec3 center = instance.worldFromModel * glm::dvec4{glm::dvec3{v.position} + 0.5, 1.0};
            const glm::ivec3 cell{glm::floor(center / kVoxel)};
            const auto [at, isNew] =
                world.cells.insert_or_assign(std::array{cell.x, cell.y, cell.z}, asset.materials[v.material]);
            world.replaced += isNew ? 0u : 1u;
        }
    }
    return world;
}

/// Whole cells: a cube of 16, one beside it of another material, and single ones.
VoxelModel solidCells() {
    VoxelModel model;
    model.fillTile({-16, 0, 16}, 4, 2);
    model.fillTile({0, 0, 16}, 4, 1);
    model.fillTile({0, 8, 16}, 3, 3);
    model.fillTile({16, 8, 8}, 3, 2);
    model.set({17, 9, 9}, 0);
    return model;
}

Bytes vdbOf(VoxelAsset asset) {
    for (Instance& instance : asset.instances) {
        instance.layer = -1;
        instance.hidden = false;
    }
    asset.source.voxelSizeMetres = kVoxel;
    DiagnosticList diagnostics;
    const OctreeAsset octrees = buildOctrees(asset, Limits{}).value();
    return exportVdb(octrees, Limits{}, diagnostics).value();
}

TEST(ImportMerge, ShowsTheSameWorldAsSeparateInstances) {
    std::mt19937 random(11);
    for (int round = 0; round < 25; ++round) {
        SCOPED_TRACE(round);
        std::vector<VoxelModel> models;
        models.push_back(patchyModel(static_cast<std::uint32_t>(random()), 40));
        models.push_back(solidCells());
        VoxelAsset asset = assetOf(std::move(models));
        asset.instances.push_back({.model = static_cast<std::uint32_t>(random() % 2)});
        for (Instance& instance : asset.instances) instance.worldFromModel = randomGridTransform(random);
        const Bytes bytes = vdbOf(std::move(asset));
        const Imported apart = importAs(bytes, "a.vdb");
        const Imported merged = importAs(bytes, "a.vdb", {.merge = true});
        ASSERT_TRUE(apart.result && merged.result) << merged.errorText();
        ASSERT_EQ(merged.result->models.size(), 1u);
        ASSERT_EQ(merged.result->instances.size(), 1u);
        EXPECT_EQ(merged.result->instances[0].worldFromModel, apart.result->instances[0].worldFromModel);
        const World expected = worldOf(*apart.result);
        EXPECT_TRUE(worldOf(*merged.result).cells == expected.cells);
        EXPECT_EQ(merged.reported("merge-overlap"), expected.replaced > 0);
        for (const Diagnostic& d : merged.diagnostics) {
            if (d.id != "merge-overlap") continue;
            EXPECT_THAT(d.message, testing::StartsWith(std::to_string(expected.replaced) + " voxels"));
        }
    }
}

TEST(ImportMerge, SolidCubesStayWholeAndAreCounted) {
    VoxelModel large;
    large.fillTile({0, 0, 0}, 10, 1);
    std::vector<VoxelModel> models;
    models.push_back(std::move(large));
    VoxelAsset asset = assetOf(std::move(models));
    asset.instances[0].worldFromModel = Affine{kVoxel};
    const auto add = [&](glm::dvec3 voxels) {
        asset.instances.push_back(asset.instances[0]);
        asset.instances.back().worldFromModel[3] = voxels * kVoxel;
    };
    add({512, 0, 0});
    add({0, 1024 + 8, 0});
    add({0, 0, 1024 + 3});  // off the grid of cells: only its faces are taken apart
    const Imported merged = importAs(vdbOf(std::move(asset)), "a.vdb", {.merge = true});
    ASSERT_TRUE(merged.result) << merged.errorText();
    const VoxelModel& model = merged.result->models[0];
    EXPECT_EQ(model.voxelCount(), (1ull << 30) * 4 - (1ull << 29));
    EXPECT_LT(model.memoryBytes(), 300u << 20) << "of 2.3 GiB in bricks";
    EXPECT_TRUE(model.at({1535, 1023, 1023}) && model.at({0, 2055, 0}) && model.at({5, 5, 1027}));
    EXPECT_FALSE(model.at({0, 1031, 0}) || model.at({5, 5, 1026}));
    const auto overlap = std::ranges::find(merged.diagnostics, "merge-overlap", &Diagnostic::id);
    ASSERT_NE(overlap, merged.diagnostics.end());
    EXPECT_THAT(overlap->message, testing::StartsWith("536870912 voxels"));
}

TEST(ImportMerge, OtherTransformsAreRefused) {
    const auto merge = [](const std::function<void(Affine&)>& change) {
        std::vector<VoxelModel> models;
        models.push_back(boxModel({0, 0, 0}, {2, 3, 4}, 1));
        VoxelAsset asset = assetOf(std::move(models));
        asset.instances[0].worldFromModel = Affine{kVoxel};
        asset.instances.push_back({.model = 0, .worldFromModel = Affine{kVoxel}, .name = "leaning"});
        change(asset.instances[1].worldFromModel);
        return importAs(vdbOf(std::move(asset)), "a.vdb", {.merge = true});
    };
    EXPECT_TRUE(merge([](Affine& a) { a[3].x += 3 * kVoxel; }).result);
    const Imported half = merge([](Affine& a) { a[3].x += 0.5 * kVoxel; });
    ASSERT_FALSE(half.result);
    EXPECT_EQ(half.result.error().code, ErrorCode::UnsupportedFeature);
    EXPECT_THAT(half.result.error().message, testing::HasSubstr("instance 1 ('leaning')"));
    EXPECT_FALSE(merge([](Affine& a) { a[0] *= 2.0; }).result);
    EXPECT_FALSE(merge([](Affine& a) { a[0].y = 0.01; }).result);
    EXPECT_FALSE(merge([](Affine& a) { a[3].x = 1e12; }).result);
}

TEST(ImportMerge, OneModelStaysAsItIs) {
    std::vector<VoxelModel> models;
    models.push_back(boxModel({0, 0, 0}, {2, 3, 4}, 1));
    models[0].name = "only";
    const Imported merged = importAs(vdbOf(assetOf(std::move(models))), "a.vdb", {.merge = true});
    ASSERT_TRUE(merged.result) << merged.errorText();
    EXPECT_EQ(merged.result->models[0].name, "only");
    EXPECT_EQ(merged.result->instances[0].name, "instance");
}

TEST(ImportMerge, CorpusFilesOfSvxAndTheThesisAreOneModelAlready) {
    std::vector<std::filesystem::path> files = corpusFiles("legacy", ".pf_vox");
    if (files.empty()) GTEST_SKIP() << "corpus/legacy is absent (set PFVOX_CORPUS_DIR to the corpus folder)";
    files.resize(std::min<std::size_t>(files.size(), 5));
    for (const auto& file : corpusFiles("svx", ".svx")) files.push_back(file);
    for (const auto& file : files) {
        SCOPED_TRACE(file.filename());
        const Imported plain = importAs(readBytes(file), file.string());
        const Imported merged = importAs(readBytes(file), file.string(), {.merge = true});
        ASSERT_EQ(plain.result.has_value(), merged.result.has_value());
        if (!plain.result) continue;
        EXPECT_EQ(merged.result->models.size(), 1u);
        EXPECT_EQ(merged.result->models[0].voxelCount(), plain.result->models[0].voxelCount());
    }
}

}  // namespace
}  // namespace pfvox::test
