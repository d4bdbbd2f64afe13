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

}  // namespace
}  // namespace pfvox
