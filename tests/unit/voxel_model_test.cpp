#include <gtest/gtest.h>

#include <map>
#include <pfvox/voxel_model.hpp>
#include <random>

namespace pfvox {
namespace {

struct LessThan {
    bool operator()(glm::ivec3 a, glm::ivec3 b) const {
        return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
    }
};

TEST(VoxelModel, BehavesLikeAMapOfVoxels) {
    std::mt19937 random(1);
    std::uniform_int_distribution<int> coordinate(-300, 300);
    std::map<glm::ivec3, MaterialIndex, LessThan> expected;
    VoxelModel model;
    for (int i = 0; i < 20000; ++i) {
        const glm::ivec3 p{coordinate(random), coordinate(random) / 50, coordinate(random) / 100};
        if (random() % 4 == 0) {
            EXPECT_EQ(model.clear(p), expected.erase(p) == 1);
        } else {
            const auto m = static_cast<MaterialIndex>(random() & 0xffff);
            model.set(p, m);
            expected[p] = m;
        }
    }
    EXPECT_EQ(model.voxelCount(), expected.size());
    VoxelBox box;
    for (const auto& [p, m] : expected) {
        ASSERT_EQ(model.at(p), m);
        box.include({p, p + 1});
    }
    EXPECT_EQ(model.bounds(), box);
}

TEST(VoxelModel, TilesFillWithoutExpansion) {
    VoxelModel model;
    model.fillTile({-4096, 0, 4096}, 12, 7);
    EXPECT_EQ(model.voxelCount(), 4096ull * 4096 * 4096);
    EXPECT_EQ(model.at({-1, 4095, 4096}), MaterialIndex{7});
    EXPECT_EQ(model.at({0, 0, 4096}), std::nullopt);
    EXPECT_LT(model.memoryBytes(), 4u << 20);
}

TEST(VoxelModel, AVoxelInsideATileKeepsTheRest) {
    VoxelModel model;
    model.fillTile({0, 0, 0}, 8, 1);
    model.set({100, 100, 100}, 2);
    EXPECT_TRUE(model.clear({5, 5, 5}));
    EXPECT_FALSE(model.clear({5, 5, 5}));
    EXPECT_EQ(model.voxelCount(), (1u << 24) - 1);
    EXPECT_EQ(model.at({100, 100, 100}), MaterialIndex{2});
    EXPECT_EQ(model.at({100, 100, 101}), MaterialIndex{1});
    EXPECT_EQ(model.at({5, 5, 5}), std::nullopt);
}

/// A list with duplicates, in an order of no use to anybody; `spread` is the range of coordinates.
std::vector<PackedVoxel> randomList(std::size_t count, std::uint32_t spread) {
    std::mt19937 random(7);
    std::vector<PackedVoxel> voxels(count);
    for (PackedVoxel& v : voxels) {
        const auto coordinate = [&] { return static_cast<std::uint16_t>(random() % spread); };
        v = {coordinate(), coordinate(), coordinate(), static_cast<MaterialIndex>(random() % 5)};
    }
    return voxels;
}

void expectInsertEqualsSet(std::span<const PackedVoxel> voxels, glm::ivec3 origin) {
    VoxelModel expected;
    for (const PackedVoxel& v : voxels) expected.set(origin + glm::ivec3{v.x, v.y, v.z}, v.material);
    VoxelModel model;
    model.insert(voxels, origin);
    EXPECT_EQ(model.voxelCount(), expected.voxelCount());
    EXPECT_EQ(model.regions().size(), expected.regions().size());
    for (const PackedVoxel& v : voxels) {
        const glm::ivec3 p = origin + glm::ivec3{v.x, v.y, v.z};
        ASSERT_EQ(model.at(p), expected.at(p));
    }
}

TEST(VoxelModelInsert, EqualsSettingOneByOne) {
    for (const std::size_t count : {0u, 1u, 2u, 3u, 4097u, 70001u}) {
        SCOPED_TRACE(count);
        expectInsertEqualsSet(randomList(count, 300), {0, 0, 0});
    }
}

TEST(VoxelModelInsert, TheLastOfSeveralInOnePlaceWins) {
    expectInsertEqualsSet(randomList(100000, 20), {0, 0, 0});
}

TEST(VoxelModelInsert, OriginMayBeAnywhere) {
    expectInsertEqualsSet(randomList(40000, 600), {-1000, 77, 1'000'003});
}

TEST(VoxelModelInsert, WidelySpreadListsWorkToo) {
    expectInsertEqualsSet(randomList(3000, 65536), {-5, 0, 9});
}

TEST(VoxelModelInsert, KeepsWhatWasThereBefore) {
    VoxelModel model;
    model.fillTile({0, 0, 0}, 8, 3);
    model.set({-1, -1, -1}, 4);
    const std::vector<PackedVoxel> voxels{{0, 0, 0, 1}, {300, 0, 0, 2}};
    model.insert(voxels);
    EXPECT_EQ(model.at({0, 0, 0}), MaterialIndex{1});
    EXPECT_EQ(model.at({1, 0, 0}), MaterialIndex{3});
    EXPECT_EQ(model.at({300, 0, 0}), MaterialIndex{2});
    EXPECT_EQ(model.at({-1, -1, -1}), MaterialIndex{4});
    EXPECT_EQ(model.voxelCount(), (1u << 24) + 2);
}

TEST(VoxelRegion, ResetLeavesNothingBehind) {
    VoxelRegion region({0, 0, 0});
    region.brickAt(5).set(1, 1);
    region.fillCell(20000, 2);
    region.reset({1, 2, 3});
    EXPECT_EQ(region.coord(), glm::ivec3(1, 2, 3));
    EXPECT_EQ(region.brickCount(), 0u);
    for (std::uint32_t c = 0; c < static_cast<std::uint32_t>(kRegionCells); ++c)
        ASSERT_TRUE(region.cell(c).empty());
    EXPECT_FALSE(region.brickAt(5).occupied(1));
}

}  // namespace
}  // namespace pfvox
