#include "octree/tree_check.hpp"

#include <fmt/format.h>
#include <array>
#include <vector>

#include "octree/lanes.hpp"

namespace pfvox::octree {

namespace {

constexpr std::uint32_t kMaxTreeDepth = 32;

tl::unexpected<Error> badNode(std::size_t index, std::string message) {
    return failAt(ErrorCode::BadStructure, index, fmt::format("node {}", index), std::move(message));
}

std::uint32_t countBits(std::uint32_t mask) {
    return kBitCount[mask];
}

/// What each node says by itself, and that the far table is used once, in order.
Result<void> checkWords(const NodeTree& tree) {
    std::size_t innerChildren = 0;
    std::size_t far = 0;
    for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
        const std::uint32_t d = tree.nodes[i];
        const std::uint32_t inner = node::innerMask(d);
        if (node::validMask(d) == 0) return badNode(i, "has no children");
        if ((node::leafMask(d) & ~node::validMask(d)) != 0) return badNode(i, "a leaf is not valid");
        innerChildren += countBits(inner);
        if (!node::isFar(d)) {
            const bool shouldPoint = inner != 0;
            if (shouldPoint != (node::pointer(d) != 0)) return badNode(i, "pointer and children contradict");
            continue;
        }
        if (inner == 0 || node::pointer(d) != far || far >= tree.farTable.size())
            return badNode(i, "wrong far pointer");
        if (tree.farTable[far++] <= node::kMaxNearPointer) return badNode(i, "needs no far pointer");
    }
    if (far != tree.farTable.size()) return fail(ErrorCode::BadStructure, "unused far pointers");
    if (innerChildren + 1 != tree.nodes.size()) {
        return fail(ErrorCode::BadStructure,
                    fmt::format("{} nodes announce {} inner children; a tree has one less than nodes",
                                tree.nodes.size(), innerChildren));
    }
    return {};
}

}  // namespace

Result<void> checkTree(const NodeTree& tree) {
    if (tree.nodes.empty()) return fail(ErrorCode::BadStructure, "a tree needs at least its root");
    if (tree.depth == 0 || tree.depth > kMaxTreeDepth)
        return fail(ErrorCode::BadStructure, fmt::format("a tree of {} levels", tree.depth));
    PFVOX_CHECK(checkWords(tree));
    // The walk that gives out places: depth first over blocks of siblings. Each pointer must name the next
    // place.
    struct Block {
        std::uint32_t next;
        std::uint32_t end;
    };
    std::array<Block, kMaxTreeDepth> stack;
    std::uint32_t levels = 1;
    stack[0] = {0, 1};
    std::uint32_t places = 1;
    while (levels > 0) {
        Block& block = stack[levels - 1];
        if (block.next == block.end) {
            --levels;
            continue;
        }
        const std::uint32_t index = block.next++;
        const std::uint32_t inner = node::innerMask(tree.nodes[index]);
        if (inner == 0) continue;
        if (levels >= tree.depth) return badNode(index, "has inner children at the last level");
        if (tree.firstChild(index) != places) return badNode(index, "its pointer breaks the order of nodes");
        // checkWords: all inner children are as many as nodes, so places never runs past the end.
        stack[levels++] = {places, places + countBits(inner)};
        places += countBits(inner);
    }
    if (places != tree.nodes.size()) return badNode(places, "is not reached from the root");
    return {};
}

Result<std::uint64_t> checkLookup(const NodeTree& tree, std::span<const std::uint32_t> lookup) {
    if (lookup.size() != tree.nodes.size()) return fail(ErrorCode::BadStructure, "not a lookup word a node");
    std::vector<std::uint8_t> covered(tree.nodes.size(), 0);  // below a value that holds for a whole subtree
    std::uint64_t values = 0;
    for (std::uint32_t i = 0; i < tree.nodes.size(); ++i) {
        const std::uint32_t d = tree.nodes[i];
        const std::uint32_t inner = node::innerMask(d);
        const std::uint32_t mask = lookup[i] & 0xffu;
        if (lookup[i] >> 8 != values) return badNode(i, "wrong value pointer");
        if (covered[i] != 0 ? mask != 0 : (mask & ~inner) != node::leafMask(d))
            return badNode(i, "its values are not those of its leaves and of whole subtrees");
        values += countBits(mask);
        if (inner == 0 || (covered[i] == 0 && (mask & inner) == 0)) continue;
        std::uint32_t child = tree.firstChild(i);
        for (std::uint32_t rest = inner; rest != 0; rest &= rest - 1, ++child) {
            if (covered[i] != 0 || (mask & rest & (~rest + 1)) != 0) covered[child] = 1;
        }
    }
    return values;
}

}  // namespace pfvox::octree
