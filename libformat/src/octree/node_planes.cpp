#include "octree/node_planes.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <bit>

namespace pfvox::octree {

namespace {

constexpr std::uint32_t kMaxTreeDepth = 32;

/// Bits of a lookup word while the tree is linked: the node lies below a hoisted value.
constexpr std::uint32_t kCovered = 1u << 8;

tl::unexpected<Error> badNode(std::size_t index, std::string message) {
    return failAt(ErrorCode::BadStructure, index, fmt::format("node {}", index), std::move(message));
}

/// Checks what can be checked node by node.
Result<void> checkMasks(const NodePlanes& planes, bool withHoisted) {
    std::size_t innerChildren = 0;
    std::size_t innerNodes = 0;
    for (std::size_t i = 0; i < planes.valid.size(); ++i) {
        const unsigned valid = planes.valid[i];
        const unsigned inner = planes.inner[i];
        if (valid == 0) return badNode(i, "no child slot is valid");
        if ((inner & ~valid) != 0) return badNode(i, "an inner child is not valid");
        innerChildren += static_cast<std::size_t>(std::popcount(inner));
        innerNodes += inner != 0 ? 1 : 0;
    }
    if (innerChildren + 1 != planes.valid.size()) {
        return fail(ErrorCode::BadStructure,
                    fmt::format("{} nodes announce {} inner children; a tree has one less than nodes",
                                planes.valid.size(), innerChildren));
    }
    if (withHoisted && planes.hoisted.size() != innerNodes) {
        return fail(ErrorCode::BadStructure, fmt::format("{} hoisted masks for {} nodes with inner children",
                                                         planes.hoisted.size(), innerNodes));
    }
    return {};
}

/// Gives every node the distance to its first child (in tree.nodes, for now) by walking the sibling blocks
/// depth first.
Result<void> walkBlocks(const NodePlanes& planes, NodeTree& tree) {
    struct Block {
        std::uint32_t next;
        std::uint32_t end;
    };
    std::array<Block, kMaxTreeDepth> stack;
    std::uint32_t levels = 1;
    stack[0] = {0, 1};
    std::uint32_t allocated = 1;
    while (levels > 0) {
        Block& block = stack[levels - 1];
        if (block.next == block.end) {
            --levels;
            continue;
        }
        const std::uint32_t index = block.next++;
        const unsigned inner = planes.inner[index];
        if (inner == 0) {
            tree.nodes[index] = 0;
            continue;
        }
        if (levels >= tree.depth) return badNode(index, "has inner children at the last level");
        const std::uint32_t first = allocated;
        allocated += static_cast<std::uint32_t>(std::popcount(inner));
        // checkMasks: the sum of all inner children is the number of nodes, so allocated never runs past the
        // end.
        tree.nodes[index] = first - index;
        stack[levels++] = {first, allocated};
    }
    if (allocated != planes.valid.size()) {
        return badNode(allocated, "is not reached from the root");
    }
    return {};
}

/// Sets the mask bits of the lookup words and the covered flag of hoisted children, then the value pointers.
Result<void> linkLookup(const NodePlanes& planes, const NodeTree& tree, std::vector<std::uint32_t>& lookup) {
    lookup.assign(planes.valid.size(), 0);
    std::size_t innerNode = 0;
    for (std::size_t i = 0; i < planes.valid.size(); ++i) {
        const unsigned inner = planes.inner[i];
        const unsigned leaf = planes.valid[i] & ~inner;
        const bool covered = (lookup[i] & kCovered) != 0;
        unsigned hoisted = 0;
        if (inner != 0) {
            hoisted = planes.hoisted[innerNode++];
            if ((hoisted & ~inner) != 0) return badNode(i, "a hoisted value belongs to no inner child");
            if (covered && hoisted != 0) return badNode(i, "a hoisted value lies below another");
            const std::size_t firstChild = i + tree.nodes[i];
            std::size_t child = firstChild;
            for (unsigned rest = inner; rest != 0; rest &= rest - 1, ++child) {
                const unsigned bit = rest & (~rest + 1);
                if (covered || (hoisted & bit) != 0) lookup[child] |= kCovered;
            }
        }
        lookup[i] = (lookup[i] & kCovered) | (covered ? 0u : leaf | hoisted);
    }
    std::uint32_t valuePointer = 0;
    for (std::uint32_t& word : lookup) {
        const std::uint32_t mask = word & 0xffu;
        word = mask | (valuePointer << 8);
        valuePointer += static_cast<std::uint32_t>(std::popcount(mask));
    }
    return {};
}

/// From masks and distances to child descriptors and the far table.
Result<void> writeDescriptors(const NodePlanes& planes, NodeTree& tree) {
    tree.farTable.clear();
    for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
        const std::uint32_t distance = tree.nodes[i];
        const unsigned leaf = planes.valid[i] & ~static_cast<unsigned>(planes.inner[i]);
        const std::uint32_t masks = leaf | (static_cast<std::uint32_t>(planes.valid[i]) << 8);
        if (distance <= node::kMaxNearPointer) {
            tree.nodes[i] = masks | (distance << node::kPointerShift);
        } else {
            if (tree.farTable.size() > node::kMaxNearPointer)
                return badNode(i, "more than 32768 far pointers");
            tree.nodes[i] = masks | node::kFarBit |
                            (static_cast<std::uint32_t>(tree.farTable.size()) << node::kPointerShift);
            tree.farTable.push_back(distance);
        }
    }
    return {};
}

}  // namespace

std::size_t countInnerNodes(const NodeTree& tree) {
    return static_cast<std::size_t>(
        std::ranges::count_if(tree.nodes, [](std::uint32_t d) { return node::innerMask(d) != 0; }));
}

std::vector<std::uint8_t> splitPlanes(const NodeTree& tree, std::span<const std::uint32_t> lookup) {
    const std::size_t n = tree.nodes.size();
    std::vector<std::uint8_t> planes(2 * n + (lookup.empty() ? 0 : countInnerNodes(tree)));
    std::uint8_t* hoisted = planes.data() + 2 * n;
    for (std::size_t i = 0; i < n; ++i) {
        const std::uint32_t inner = node::innerMask(tree.nodes[i]);
        planes[i] = static_cast<std::uint8_t>(node::validMask(tree.nodes[i]));
        planes[n + i] = static_cast<std::uint8_t>(inner);
        if (inner != 0 && !lookup.empty()) *hoisted++ = static_cast<std::uint8_t>(lookup[i] & inner);
    }
    return planes;
}

Result<void> linkPlanes(const NodePlanes& planes, NodeTree& tree, std::vector<std::uint32_t>* lookup) {
    if (planes.valid.empty() || planes.inner.size() != planes.valid.size()) {
        return fail(ErrorCode::BadStructure, "a tree needs at least its root");
    }
    if (tree.depth == 0 || tree.depth > kMaxTreeDepth) {
        return fail(ErrorCode::BadStructure, fmt::format("a tree of {} levels", tree.depth));
    }
    PFVOX_CHECK(checkMasks(planes, lookup != nullptr));
    tree.nodes.resize(planes.valid.size());
    PFVOX_CHECK(walkBlocks(planes, tree));
    if (lookup != nullptr) PFVOX_CHECK(linkLookup(planes, tree, *lookup));
    return writeDescriptors(planes, tree);
}

}  // namespace pfvox::octree
