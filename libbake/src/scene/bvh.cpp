#include "scene/bvh.hpp"

#include <algorithm>
#include <array>
#include <numeric>

namespace pfvox::gpu::detail {

namespace {

constexpr std::size_t kBins = 16;
constexpr std::size_t kMaxLeafBoxes = 4;
constexpr float kInstanceCost = 8.0f;  // one ray through an octree, in box pairs tested
// Below this depth splits halve the number of boxes: 2^22 instances then end well before kBvhStackSize.
constexpr std::uint32_t kSahDepth = 16;

struct Range {
    std::uint32_t begin = 0;
    std::uint32_t end = 0;
    std::uint32_t size() const { return end - begin; }
};

struct Split {
    int axis = 0;
    std::size_t bin = 0;  ///< the first bin of the right side
    float cost = std::numeric_limits<float>::infinity();
};

struct Bin {
    Box box;
    std::uint32_t count = 0;
};

class Builder {
  public:
    explicit Builder(std::span<const Box> boxes) : boxes_(boxes) {
        bvh_.order.resize(boxes.size());
        std::iota(bvh_.order.begin(), bvh_.order.end(), 0u);
        bvh_.nodes.reserve(2 * boxes.size());
    }

    Bvh build() {
        if (boxes_.empty()) return {};
        bvh_.nodes.emplace_back();
        buildNode(0, {0, static_cast<std::uint32_t>(boxes_.size())}, 0);
        return std::move(bvh_);
    }

  private:
    void buildNode(std::size_t index, Range range, std::uint32_t depth) {
        Box box;
        Box centers;
        for (std::uint32_t i = range.begin; i < range.end; ++i) {
            box.include(boxes_[bvh_.order[i]]);
            centers.include(boxes_[bvh_.order[i]].center());
        }
        bvh_.nodes[index] = {
            .boxMin = box.min, .first = range.begin, .boxMax = box.max, .count = range.size()};
        if (range.size() == 1) return;

        const Split split = bestSplit(range, centers);
        const float splitCost = 1.0f + kInstanceCost * split.cost / std::max(box.halfArea(), 1e-30f);
        const float leafCost = kInstanceCost * static_cast<float>(range.size());
        if (range.size() <= kMaxLeafBoxes && !(splitCost < leafCost)) return;

        const bool useSah = depth < kSahDepth && splitCost < std::numeric_limits<float>::infinity();
        const std::uint32_t middle =
            useSah ? partitionAt(range, centers, split) : partitionHalf(range, centers);
        const std::size_t left = bvh_.nodes.size();
        bvh_.nodes.resize(left + 2);
        bvh_.nodes[index].first = static_cast<std::uint32_t>(left);
        bvh_.nodes[index].count = 0;
        buildNode(left, {range.begin, middle}, depth + 1);
        buildNode(left + 1, {middle, range.end}, depth + 1);
    }

    static std::size_t binOf(const Box& box, const Box& centers, int axis) {
        const float extent = centers.max[axis] - centers.min[axis];
        const float place = (box.center()[axis] - centers.min[axis]) / extent;
        return std::min(static_cast<std::size_t>(std::max(place, 0.0f) * static_cast<float>(kBins)),
                        kBins - 1);
    }

    /// Cost: sum over both sides of half area x boxes. Infinite when all centers coincide.
    Split bestSplit(Range range, const Box& centers) const {
        Split best;
        for (int axis = 0; axis < 3; ++axis) {
            if (!(centers.max[axis] > centers.min[axis])) continue;
            std::array<Bin, kBins> bins;
            for (std::uint32_t i = range.begin; i < range.end; ++i) {
                Bin& bin = bins[binOf(boxes_[bvh_.order[i]], centers, axis)];
                bin.box.include(boxes_[bvh_.order[i]]);
                ++bin.count;
            }
            sweep(bins, axis, best);
        }
        return best;
    }

    static void sweep(const std::array<Bin, kBins>& bins, int axis, Split& best) {
        std::array<float, kBins> rightCost{};
        Bin right;
        for (std::size_t b = kBins - 1; b > 0; --b) {
            right.box.include(bins[b].box);
            right.count += bins[b].count;
            rightCost[b] = right.count == 0 ? 0.0f : right.box.halfArea() * static_cast<float>(right.count);
        }
        Bin left;
        std::uint32_t total = 0;
        for (const Bin& bin : bins) total += bin.count;
        for (std::size_t b = 1; b < kBins; ++b) {
            left.box.include(bins[b - 1].box);
            left.count += bins[b - 1].count;
            if (left.count == 0 || left.count == total) continue;
            const float cost = left.box.halfArea() * static_cast<float>(left.count) + rightCost[b];
            if (cost < best.cost) best = {.axis = axis, .bin = b, .cost = cost};
        }
    }

    std::uint32_t partitionAt(Range range, const Box& centers, const Split& split) {
        const auto begin = bvh_.order.begin();
        const auto middle = std::partition(begin + range.begin, begin + range.end, [&](std::uint32_t box) {
            return binOf(boxes_[box], centers, split.axis) < split.bin;
        });
        return static_cast<std::uint32_t>(middle - begin);
    }

    std::uint32_t partitionHalf(Range range, const Box& centers) {
        const glm::vec3 extent = centers.max - centers.min;
        const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
        const std::uint32_t middle = range.begin + range.size() / 2;
        const auto begin = bvh_.order.begin();
        std::nth_element(begin + range.begin, begin + middle, begin + range.end,
                         [&](std::uint32_t a, std::uint32_t b) {
                             return boxes_[a].center()[axis] < boxes_[b].center()[axis];
                         });
        return middle;
    }

    std::span<const Box> boxes_;
    Bvh bvh_;
};

}  // namespace

Bvh buildBvh(std::span<const Box> boxes) {
    return Builder(boxes).build();
}

}  // namespace pfvox::gpu::detail
