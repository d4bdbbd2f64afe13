// PlaneLinker against planes that are wrong in one place, and the pool that its trees lie in.
#include <gtest/gtest.h>

#include <cstring>
#include <numeric>
#include <random>
#include <thread>

#include "octree/node_planes.hpp"
#include "octree/plane_linker.hpp"
#include "octree/tree_check.hpp"

namespace pfvox::test {
namespace {

/// A region with noise, solid parts and values that hold for whole subtrees.
OctreeRegion makeRegion(unsigned seed, int edge) {
    std::mt19937 random(seed);
    VoxelAsset asset;
    asset.materials.resize(4);
    VoxelModel& model = asset.models.emplace_back();
    for (int i = 0; i < edge * edge; ++i) {
        const auto at = [&] { return static_cast<int>(random() % static_cast<unsigned>(edge)); };
        const glm::ivec3 p{at(), at(), at()};
        model.set(p, static_cast<MaterialIndex>(p.x / 8 % 2 == 0 ? 0 : random() % 4));
    }
    model.fillTile({0, 0, 0}, 4, 1);
    return std::move(buildOctrees(asset, Limits{}).value().models[0].regions[0]);
}

TEST(PlaneLinker, RebuildsWhatWasSplit) {
    octree::PlaneLinker linker;  // one for all: nothing may stay of the tree before
    for (const int edge : {200, 9, 64, 3, 17}) {
        const OctreeRegion region = makeRegion(static_cast<unsigned>(edge), edge);
        const auto bytes = octree::splitPlanes(region.tree, region.lookup);
        NodeTree tree;
        tree.depth = region.tree.depth;
        PooledVector<std::uint32_t> lookup;
        const auto values = linker.linkRegion(
            octree::cutPlanes(bytes, region.tree.nodes.size(), octree::countBranches(region.tree), true),
            tree, lookup);
        ASSERT_TRUE(values) << values.error().message;
        EXPECT_EQ(*values, region.valueCount());
        EXPECT_EQ(tree.nodes, region.tree.nodes);
        EXPECT_EQ(tree.farTable, region.tree.farTable);
        EXPECT_EQ(lookup, region.lookup);
    }
}

/// Whatever single bit of the planes is wrong: refused, or a tree that the independent check accepts.
TEST(PlaneLinker, WrongBitsAreRefusedOrMakeAnotherWholeTree) {
    const OctreeRegion region = makeRegion(1, 24);
    const auto good = octree::splitPlanes(region.tree, region.lookup);
    const std::size_t n = region.tree.nodes.size();
    const std::size_t branches = octree::countBranches(region.tree);
    octree::PlaneLinker linker;
    int refused = 0;
    int accepted = 0;
    for (std::size_t bit = 0; bit < 8 * good.size(); bit += 3) {
        auto bytes = good;
        bytes[bit / 8] ^= static_cast<std::uint8_t>(1u << (bit % 8));
        NodeTree tree;
        tree.depth = region.tree.depth;
        PooledVector<std::uint32_t> lookup;
        const auto values = linker.linkRegion(octree::cutPlanes(bytes, n, branches, true), tree, lookup);
        if (!values) {
            EXPECT_EQ(values.error().code, ErrorCode::BadStructure);
            EXPECT_FALSE(values.error().message.empty());
            ++refused;
            continue;
        }
        ++accepted;
        ASSERT_TRUE(octree::checkTree(tree)) << "bit " << bit;
        const auto checked = octree::checkLookup(tree, lookup);
        ASSERT_TRUE(checked) << "bit " << bit << ": " << checked.error().message;
        EXPECT_EQ(*checked, *values);
    }
    EXPECT_GT(refused, 0);
    EXPECT_GT(accepted, 0);
}

TEST(PlaneLinker, NamesTheNode) {
    octree::PlaneLinker linker;
    NodeTree tree;
    tree.depth = 2;
    const auto link = [&](std::vector<std::uint8_t> bytes) {
        const auto result = linker.linkTree(octree::cutPlanes(bytes, 2, 1, false), tree);
        return result ? std::string("fine") : result.error().context + ": " + result.error().message;
    };
    // inner[2], branchLeaves[1], tipLeaves[1]
    EXPECT_EQ(link({1, 0, 2, 0xff}), "fine");
    EXPECT_EQ(link({1, 0, 1, 0xff}), "node 0: a child is leaf and inner node at once");
    EXPECT_EQ(link({1, 0, 2, 0}), "node 1: has no children");
    tree.depth = 1;
    EXPECT_EQ(link({1, 0, 2, 0xff}), "node 0: has inner children at the last level");
}

TEST(PooledVector, LivesInThePoolAndCopiesToTheHeap) {
    auto pool = std::make_shared<MemoryPool>(1000);
    PooledVector<std::uint32_t> first{PoolAllocator<std::uint32_t>(pool)};
    first.resize(10);
    std::iota(first.begin(), first.end(), 0u);
    const std::uint32_t* const place = first.data();
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(place) % MemoryPool::kAlignment, 0u);
    const PooledVector<std::uint32_t> copy = first;
    EXPECT_EQ(copy.get_allocator().pool(), nullptr);
    PooledVector<std::uint32_t> moved;
    moved = std::move(first);
    EXPECT_EQ(moved.data(), place);
    pool.reset();  // the vector keeps it
    EXPECT_TRUE(std::ranges::equal(moved, copy));
}

TEST(PooledVector, ManyThreadsGetPlacesOfTheirOwn) {
    MemoryPool pool;
    constexpr std::size_t kBytes = 100;
    std::vector<std::vector<std::byte*>> places(4);
    std::vector<std::thread> threads;
    for (std::size_t t = 0; t < places.size(); ++t) {
        threads.emplace_back([&, t] {
            for (int i = 0; i < 5000; ++i) {
                places[t].push_back(static_cast<std::byte*>(pool.take(kBytes)));
                std::memset(places[t].back(), static_cast<int>(t), kBytes);
            }
        });
    }
    for (std::thread& thread : threads) thread.join();
    for (std::size_t t = 0; t < places.size(); ++t) {
        for (const std::byte* place : places[t]) {
            ASSERT_EQ(place[0], std::byte(t));
            ASSERT_EQ(place[kBytes - 1], std::byte(t));
        }
    }
}

}  // namespace
}  // namespace pfvox::test
