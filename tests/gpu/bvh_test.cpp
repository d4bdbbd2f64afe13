// The BVH holds every box once, encloses it at every level, and keeps the depth that the shader's stack has.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <pfvox/assert.hpp>

#include "scene/bvh.hpp"
#include "support/procedural.hpp"

namespace pfvox::test {
namespace {

using gpu::detail::Box;
using gpu::detail::Bvh;

bool encloses(const shared::BvhNode& node, const Box& box) {
    return glm::all(glm::lessThanEqual(node.boxMin, box.min)) &&
           glm::all(glm::greaterThanEqual(node.boxMax, box.max));
}

/// Checks the subtree and returns its depth; counts how often each box is met.
std::uint32_t checkSubtree(const Bvh& bvh, std::span<const Box> boxes, std::uint32_t index,
                           std::vector<int>& met) {
    const shared::BvhNode& node = bvh.nodes[index];
    if (node.count != 0) {
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
            EXPECT_TRUE(encloses(node, boxes[bvh.order[i]]));
            ++met[bvh.order[i]];
        }
        return 1;
    }
    std::uint32_t depth = 0;
    for (std::uint32_t child = node.first; child < node.first + 2; ++child) {
        const shared::BvhNode& c = bvh.nodes[child];
        EXPECT_TRUE(encloses(node, Box{.min = c.boxMin, .max = c.boxMax}));
        depth = std::max(depth, checkSubtree(bvh, boxes, child, met));
    }
    return depth + 1;
}

void check(std::span<const Box> boxes) {
    const Bvh bvh = gpu::detail::buildBvh(boxes);
    std::vector<int> met(boxes.size(), 0);
    ASSERT_FALSE(bvh.nodes.empty());
    EXPECT_LT(checkSubtree(bvh, boxes, 0, met), shared::kBvhStackSize);
    EXPECT_TRUE(std::ranges::all_of(met, [](int count) { return count == 1; }));
}

std::vector<Box> randomBoxes(std::size_t count) {
    Random random(7);
    std::vector<Box> boxes(count);
    for (Box& box : boxes) {
        const glm::vec3 center(random.uniform(-50, 50), random.uniform(-5, 5), random.uniform(-50, 50));
        const glm::vec3 half(random.uniform(0.1, 2), random.uniform(0.1, 2), random.uniform(0.1, 2));
        box = {.min = center - half, .max = center + half};
    }
    return boxes;
}

TEST(Bvh, NoBoxesGiveNoNodes) {
    EXPECT_TRUE(gpu::detail::buildBvh({}).nodes.empty());
}

TEST(Bvh, HoldsEveryBoxOnce) {
    for (const std::size_t count : {1u, 2u, 3u, 5u, 64u, 5000u}) check(randomBoxes(count));
}

TEST(Bvh, SameBoxesEverywhere) {
    check(std::vector<Box>(1000, Box{.min = glm::vec3(1), .max = glm::vec3(2)}));
}

TEST(Bvh, DepthIsBoundedForBoxesOfGrowingSize) {
    // Each box is twice as far out as the one before: the heuristic splits off one at a time.
    std::vector<Box> boxes;
    for (int i = 0; i < 120; ++i) {
        const float at = std::ldexp(1.0f, i);
        boxes.push_back({.min = glm::vec3(at), .max = glm::vec3(1.1f * at)});
    }
    check(boxes);
}

TEST(Bvh, ThousandsOfBoxesTakeMilliseconds) {
    const std::vector<Box> boxes = randomBoxes(10000);
    const auto started = std::chrono::steady_clock::now();
    const Bvh bvh = gpu::detail::buildBvh(boxes);
    const std::chrono::duration<double, std::milli> elapsed = std::chrono::steady_clock::now() - started;
    RecordProperty("milliseconds", std::to_string(elapsed.count()));
    EXPECT_LT(elapsed.count(), 500.0);  // some 10 ms on an idle machine
}

}  // namespace
}  // namespace pfvox::test
