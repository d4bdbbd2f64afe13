// What must hold for every octree: each voxel keeps its material, nothing that could merge is left apart, no
// value is stored twice on a path, and a file gives back what went in.
#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <bit>
#include <pfvox/octree.hpp>
#include <pfvox/pf_vox.hpp>
#include <random>

#include "support/voxel_models.hpp"

namespace pfvox {
namespace {

using test::standardModels;

OctreeAsset build(const VoxelAsset& asset) {
    auto built = buildOctrees(asset, Limits{});
    EXPECT_TRUE(built) << (built ? "" : describe(built.error()));
    return built ? *std::move(built) : OctreeAsset{};
}

OctreeAsset buildStandard() {
    std::vector<VoxelModel> models;
    for (test::NamedModel& named : standardModels()) models.push_back(std::move(named.model));
    return build(test::assetOf(std::move(models)));
}

/// The same voxels in both: walks what each of them holds and asks the other.
void expectSameVoxels(const VoxelModel& expected, const OctreeModel& octree) {
    EXPECT_EQ(octree.voxelCount, expected.voxelCount());
    if (expected.voxelCount() == 0) return;
    EXPECT_EQ(octree.bounds, expected.bounds());
    const VoxelModel back = toVoxelModel(octree);
    EXPECT_EQ(back.voxelCount(), expected.voxelCount());
    std::uint64_t compared = 0;
    for (const auto& region : expected.regions()) {
        for (std::uint32_t c = 0; c < static_cast<std::uint32_t>(kRegionCells); ++c) {
            const auto cell = region->cell(c);
            if (cell.empty()) continue;
            const glm::ivec3 corner =
                region->coord() * kRegionEdge + glm::ivec3{mortonDecode(c)} * kBrickEdge;
            const std::uint32_t step = cell.brick != nullptr ? 1 : 73;  // tiles: a sample is enough
            for (std::uint32_t m = 0; m < kBrickVoxels; m += step) {
                const glm::ivec3 p = corner + glm::ivec3{mortonDecode(m)};
                ASSERT_EQ(octree.at(p), expected.at(p)) << p.x << ' ' << p.y << ' ' << p.z;
                ASSERT_EQ(back.at(p), expected.at(p));
                ++compared;
            }
        }
    }
    EXPECT_GT(compared, 0u);
}

TEST(OctreeProperties, EveryVoxelKeepsItsMaterial) {
    const std::vector<test::NamedModel> named = standardModels();
    const OctreeAsset built = buildStandard();
    ASSERT_EQ(built.models.size(), named.size());
    for (std::size_t i = 0; i < named.size(); ++i) {
        SCOPED_TRACE(named[i].name);
        expectSameVoxels(named[i].model, built.models[i]);
    }
}

/// Leaves of the exactly minimised octree over the cube, by asking for every voxel: slow and obvious.
std::uint64_t countLeaves(const VoxelModel& model, glm::ivec3 corner, int edge,
                          std::optional<MaterialIndex>& uniform) {
    if (edge == 1) {
        uniform = model.at(corner);
        return uniform ? 1 : 0;
    }
    std::uint64_t leaves = 0;
    bool merge = true;
    std::optional<MaterialIndex> first;
    for (int k = 0; k < 8; ++k) {
        std::optional<MaterialIndex> child;
        leaves += countLeaves(model, corner + glm::ivec3{k & 1, (k >> 1) & 1, k >> 2} * (edge / 2), edge / 2,
                              child);
        if (k == 0) first = child;
        merge = merge && child && child == first;
    }
    uniform = merge ? first : std::nullopt;
    return merge ? 1 : leaves;
}

TEST(OctreeProperties, MinimisationIsComplete) {
    for (std::uint32_t seed = 0; seed < 8; ++seed) {
        const int edge = 8 << (seed % 3);
        VoxelModel model = test::patchyModel(seed, edge);
        std::optional<MaterialIndex> uniform;
        std::uint64_t expected = countLeaves(model, {0, 0, 0}, edge, uniform);
        const OctreeAsset built = build(test::assetOf([&] {
            std::vector<VoxelModel> models;
            models.push_back(std::move(model));
            return models;
        }()));
        const OctreeStatistics s = statistics(built.models[0], built.materials.size());
        // A root is always a node: where everything is one cube it has eight leaves.
        if (expected == 1) expected = 8;
        EXPECT_EQ(s.leaves, expected) << "seed " << seed;
    }
}

TEST(OctreeProperties, ValuesAreHoistedAsHighAsTheyGo) {
    const OctreeAsset built = buildStandard();
    for (const OctreeModel& model : built.models) {
        for (const OctreeRegion& region : model.regions) {
            // No node may have all its values equal with everything below it valued here, unless it is the
            // root: then its parent would hold the one value.
            for (std::size_t i = 1; i < region.tree.nodes.size(); ++i) {
                const std::uint32_t valid = node::validMask(region.tree.nodes[i]);
                const std::uint32_t mask = region.lookup[i] & 0xffu;
                if (mask != valid) continue;
                const std::uint32_t first = region.lookup[i] >> 8;
                bool allEqual = true;
                for (int k = 1; k < std::popcount(mask); ++k) {
                    allEqual = allEqual &&
                               region.value(first + static_cast<std::uint32_t>(k)) == region.value(first);
                }
                EXPECT_FALSE(allEqual) << "node " << i;
            }
        }
    }
}

TEST(OctreeProperties, NodesAreReachedOnceAndForward) {
    const OctreeAsset built = buildStandard();
    for (const OctreeModel& model : built.models) {
        for (const OctreeRegion& region : model.regions) {
            std::vector<int> reached(region.tree.nodes.size(), 0);
            reached[0] = 1;
            for (std::uint32_t i = 0; i < region.tree.nodes.size(); ++i) {
                const auto inner =
                    static_cast<std::uint32_t>(std::popcount(node::innerMask(region.tree.nodes[i])));
                if (inner == 0) continue;
                const std::uint32_t first = region.tree.firstChild(i);
                ASSERT_GT(first, i);
                ASSERT_LE(first + inner, region.tree.nodes.size());
                for (std::uint32_t c = first; c < first + inner; ++c) ++reached[c];
            }
            EXPECT_TRUE(std::ranges::all_of(reached, [](int n) { return n == 1; }));
        }
    }
}

TEST(OctreeProperties, DepthIsTheSmallestThatFits) {
    const std::vector<test::NamedModel> named = standardModels();
    const OctreeAsset built = buildStandard();
    for (std::size_t i = 0; i < named.size(); ++i) {
        SCOPED_TRACE(named[i].name);
        const OctreeModel& model = built.models[i];
        if (model.regions.size() != 1) continue;
        EXPECT_GE(model.depth, 1u);
        if (model.depth == 1) continue;
        // More than one octant of the root is used.
        EXPECT_GT(std::popcount(node::validMask(model.regions[0].tree.nodes[0])), 1);
    }
}

TEST(OctreeProperties, LargeRandomRegionNeedsFarPointersAndKeepsThem) {
    std::vector<VoxelModel> models;
    models.push_back(test::randomModel(77, {0, 0, 0}, {160, 160, 160}, 0.2, 4));
    const OctreeAsset built = build(test::assetOf(std::move(models)));
    ASSERT_EQ(built.models[0].regions.size(), 1u);
    EXPECT_GT(built.models[0].regions[0].tree.farTable.size(), 0u);
    const auto bytes = encodePfVox(built, {});
    ASSERT_TRUE(bytes);
    DiagnosticList diagnostics;
    const auto decoded = decodePfVox(*bytes, Limits{}, diagnostics);
    ASSERT_TRUE(decoded) << describe(decoded.error());
    EXPECT_EQ(decoded->models[0].regions[0].tree.nodes, built.models[0].regions[0].tree.nodes);
    EXPECT_EQ(decoded->models[0].regions[0].tree.farTable, built.models[0].regions[0].tree.farTable);
}

void expectEqual(const OctreeRegion& a, const OctreeRegion& b) {
    EXPECT_EQ(a.originVoxels, b.originVoxels);
    EXPECT_EQ(a.tree.depth, b.tree.depth);
    EXPECT_EQ(a.tree.nodes, b.tree.nodes);
    EXPECT_EQ(a.tree.farTable, b.tree.farTable);
    EXPECT_EQ(a.lookup, b.lookup);
    EXPECT_EQ(a.values, b.values);
    EXPECT_EQ(a.palette, b.palette);
    EXPECT_EQ(a.voxelCount, b.voxelCount);
    EXPECT_EQ(a.bounds, b.bounds);
}

TEST(OctreeFromList, EqualsTheOctreeOfTheModel) {
    std::mt19937 random(11);
    for (const std::uint32_t spread : {1u, 8u, 200u, 900u, 30000u}) {
        for (const glm::ivec3 origin : {glm::ivec3{0}, glm::ivec3{-333, 12, 5000}}) {
            SCOPED_TRACE(spread);
            std::vector<PackedVoxel> list(20000);
            for (PackedVoxel& v : list) {
                const auto coordinate = [&](std::uint32_t range) {
                    return static_cast<std::uint16_t>(random() % range);
                };
                v = {coordinate(spread), coordinate(spread / 2 + 1), coordinate(spread), coordinate(4)};
            }
            std::vector<VoxelModel> models(1);
            for (const PackedVoxel& v : list) models[0].set(origin + glm::ivec3{v.x, v.y, v.z}, v.material);
            const OctreeAsset expected = build(test::assetOf(std::move(models)));
            const auto built =
                buildOctree({.voxels = list, .origin = origin}, expected.materials.size(), Limits{});
            ASSERT_TRUE(built) << describe(built.error());
            EXPECT_EQ(built->topTree.nodes, expected.models[0].topTree.nodes);
            EXPECT_EQ(built->originVoxels, expected.models[0].originVoxels);
            EXPECT_EQ(built->depth, expected.models[0].depth);
            ASSERT_EQ(built->regions.size(), expected.models[0].regions.size());
            for (std::size_t r = 0; r < built->regions.size(); ++r) {
                expectEqual(built->regions[r], expected.models[0].regions[r]);
            }
        }
    }
}

TEST(OctreeFromList, AnEmptyListIsAnEmptyModel) {
    const auto built = buildOctree({}, 0, Limits{});
    ASSERT_TRUE(built);
    EXPECT_TRUE(built->regions.empty());
    EXPECT_EQ(built->voxelCount, 0u);
}

TEST(OctreeFromList, MaterialThatDoesNotExistIsRefused) {
    const std::vector<PackedVoxel> list{{1, 2, 3, 7}};
    const auto built = buildOctree({.voxels = list}, 7, Limits{});
    ASSERT_FALSE(built);
    EXPECT_EQ(built.error().code, ErrorCode::BadReference);
}

TEST(PfVoxRoundTrip, DecodedAssetEqualsEncodedAsset) {
    const OctreeAsset built = buildStandard();
    const auto bytes = encodePfVox(built, {});
    ASSERT_TRUE(bytes) << describe(bytes.error());
    EXPECT_TRUE(validatePfVox(*bytes, Limits{}).empty());
    DiagnosticList diagnostics;
    const auto decoded = decodePfVox(*bytes, Limits{}, diagnostics);
    ASSERT_TRUE(decoded) << describe(decoded.error());
    EXPECT_TRUE(diagnostics.entries().empty());

    EXPECT_EQ(decoded->materials, built.materials);
    EXPECT_EQ(decoded->layers, built.layers);
    EXPECT_EQ(decoded->source.format, "test");
    EXPECT_EQ(decoded->source.voxelSizeMetres, 0.125);
    EXPECT_EQ(decoded->source.notes, built.source.notes);
    ASSERT_EQ(decoded->cameras.size(), 1u);
    EXPECT_EQ(decoded->cameras[0].position, built.cameras[0].position);
    ASSERT_EQ(decoded->instances.size(), built.instances.size());
    for (std::size_t i = 0; i < built.instances.size(); ++i) {
        EXPECT_EQ(decoded->instances[i].model, built.instances[i].model);
        EXPECT_EQ(decoded->instances[i].worldFromModel, built.instances[i].worldFromModel);
        EXPECT_EQ(decoded->instances[i].hidden, built.instances[i].hidden);
        EXPECT_EQ(decoded->instances[i].layer, built.instances[i].layer);
    }
    ASSERT_EQ(decoded->models.size(), built.models.size());
    for (std::size_t m = 0; m < built.models.size(); ++m) {
        const OctreeModel& a = decoded->models[m];
        const OctreeModel& b = built.models[m];
        EXPECT_EQ(a.name, b.name);
        EXPECT_EQ(a.depth, b.depth);
        EXPECT_EQ(a.originVoxels, b.originVoxels);
        EXPECT_EQ(a.topTree.nodes, b.topTree.nodes);
        EXPECT_EQ(a.topTree.farTable, b.topTree.farTable);
        EXPECT_EQ(a.topFirstRegion, b.topFirstRegion);
        EXPECT_EQ(a.voxelCount, b.voxelCount);
        ASSERT_EQ(a.regions.size(), b.regions.size());
        for (std::size_t r = 0; r < a.regions.size(); ++r) expectEqual(a.regions[r], b.regions[r]);
    }
}

TEST(PfVoxRoundTrip, MoreThan256MaterialsInARegionTakeTwoByteValues) {
    VoxelAsset asset;
    for (int i = 0; i < 1000; ++i) {
        asset.materials.push_back({.baseColor = {i & 255, i >> 8, 7, 255}});
    }
    VoxelModel model;
    for (int i = 0; i < 1000; ++i) model.set({i % 10, i / 10 % 10, i / 100}, static_cast<MaterialIndex>(i));
    asset.models.push_back(std::move(model));
    const OctreeAsset built = build(asset);
    EXPECT_EQ(built.models[0].regions[0].valueBytes(), 2u);
    const auto bytes = encodePfVox(built, {});
    ASSERT_TRUE(bytes);
    DiagnosticList diagnostics;
    const auto decoded = decodePfVox(*bytes, Limits{}, diagnostics);
    ASSERT_TRUE(decoded) << describe(decoded.error());
    for (int i = 0; i < 1000; ++i) {
        ASSERT_EQ(decoded->models[0].at({i % 10, i / 10 % 10, i / 100}), static_cast<MaterialIndex>(i));
    }
}

TEST(PfVoxDeterminism, SameBytesForAnyNumberOfThreads) {
    std::vector<std::vector<std::byte>> files;
    for (const int threads : {1, 2, 8}) {
        const tbb::global_control parallelism(tbb::global_control::max_allowed_parallelism, 8);
        tbb::task_arena arena(threads);
        arena.execute([&] {
            auto bytes = encodePfVox(buildStandard(), {});
            ASSERT_TRUE(bytes);
            files.push_back(*std::move(bytes));
        });
    }
    ASSERT_EQ(files.size(), 3u);
    EXPECT_EQ(files[0], files[1]);
    EXPECT_EQ(files[0], files[2]);
}

TEST(PfVoxDeterminism, OrderOfInsertionDoesNotMatter) {
    const VoxelModel forward = test::randomModel(5, {-40, 0, 0}, {40, 20, 300}, 0.05, 4);
    std::vector<test::Voxel> voxels = test::voxelsIn(forward, forward.bounds());
    std::ranges::reverse(voxels);
    VoxelModel backward;
    for (const test::Voxel& v : voxels) backward.set(v.position, v.material);
    const auto encode = [](VoxelModel model) {
        std::vector<VoxelModel> models;
        models.push_back(std::move(model));
        return encodePfVox(build(test::assetOf(std::move(models))), {}).value();
    };
    EXPECT_EQ(encode(test::randomModel(5, {-40, 0, 0}, {40, 20, 300}, 0.05, 4)), encode(std::move(backward)));
}

TEST(OctreeLimits, TwoVoxelsFarApartAreRefusedByName) {
    VoxelModel model;
    model.set({0, 0, 0}, 0);
    model.set({1'000'000'000, 0, 0}, 0);
    std::vector<VoxelModel> models;
    models.push_back(std::move(model));
    const auto built = buildOctrees(test::assetOf(std::move(models)), Limits{});
    ASSERT_FALSE(built);
    EXPECT_EQ(built.error().code, ErrorCode::LimitExceeded);
    EXPECT_NE(built.error().message.find("maxModelDepth"), std::string::npos) << built.error().message;
}

TEST(OctreeLimits, MaterialThatDoesNotExistIsRefused) {
    VoxelAsset asset;
    asset.materials.resize(2);
    VoxelModel model;
    model.set({1, 2, 3}, 2);
    asset.models.push_back(std::move(model));
    const auto built = buildOctrees(asset, Limits{});
    ASSERT_FALSE(built);
    EXPECT_EQ(built.error().code, ErrorCode::BadReference);
}

}  // namespace
}  // namespace pfvox
