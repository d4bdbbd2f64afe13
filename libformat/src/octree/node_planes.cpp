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

/// Leaf and inner masks of every node, in node order.
struct NodeMasks {
    std::vector<std::uint8_t> leaf;
    std::span<const std::uint8_t> inner;
    std::size_t size() const { return leaf.size(); }
};

/// Joins the leaf planes and checks what can be checked node by node.
Result<NodeMasks> joinMasks(const NodePlanes& planes) {
    NodeMasks masks{.leaf = std::vector<std::uint8_t>(planes.inner.size()), .inner = planes.inner};
    std::size_t innerChildren = 0;
    std::size_t branches = 0;
    for (std::size_t i = 0; i < masks.size(); ++i) {
        const unsigned inner = planes.inner[i];
        if (inner == 0) {
            if (i - branches >= planes.tipLeaves.size()) return badNode(i, "the tip plane is too short");
            masks.leaf[i] = planes.tipLeaves[i - branches];
            if (masks.leaf[i] == 0) return badNode(i, "has no children");
            continue;
        }
        if (branches >= planes.branchLeaves.size()) return badNode(i, "the branch plane is too short");
        masks.leaf[i] = planes.branchLeaves[branches++];
        if ((masks.leaf[i] & inner) != 0) return badNode(i, "a child is leaf and inner node at once");
        innerChildren += static_cast<std::size_t>(std::popcount(inner));
    }
    if (branches != planes.branchLeaves.size()) {
        return fail(ErrorCode::BadStructure, "the announced number of nodes with inner children is wrong");
    }
    if (innerChildren + 1 != masks.size()) {
        return fail(ErrorCode::BadStructure,
                    fmt::format("{} nodes announce {} inner children; a tree has one less than nodes",
                                masks.size(), innerChildren));
    }
    return masks;
}

/// Gives every node the distance to its first child (in tree.nodes, for now) by walking the sibling blocks
/// depth first.
Result<void> walkBlocks(const NodeMasks& masks, NodeTree& tree) {
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
        const unsigned inner = masks.inner[index];
        if (inner == 0) {
            tree.nodes[index] = 0;
            continue;
        }
        if (levels >= tree.depth) return badNode(index, "has inner children at the last level");
        const std::uint32_t first = allocated;
        allocated += static_cast<std::uint32_t>(std::popcount(inner));
        // joinMasks: the sum of all inner children is the number of nodes, so allocated never runs past the
        // end.
        tree.nodes[index] = first - index;
        stack[levels++] = {first, allocated};
    }
    if (allocated != masks.size()) {
        return badNode(allocated, "is not reached from the root");
    }
    return {};
}

/// Sets the mask bits of the lookup words and the covered flag of hoisted children, then the value pointers.
Result<void> linkLookup(const NodeMasks& masks, std::span<const std::uint8_t> hoistedPlane,
                        const NodeTree& tree, std::vector<std::uint32_t>& lookup) {
    lookup.assign(masks.size(), 0);
    std::size_t branch = 0;
    for (std::size_t i = 0; i < masks.size(); ++i) {
        const unsigned inner = masks.inner[i];
        const unsigned leaf = masks.leaf[i];
        const bool covered = (lookup[i] & kCovered) != 0;
        unsigned hoisted = 0;
        if (inner != 0) {
            hoisted = hoistedPlane[branch++];
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
Result<void> writeDescriptors(const NodeMasks& masks, NodeTree& tree) {
    tree.farTable.clear();
    for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
        const std::uint32_t distance = tree.nodes[i];
        const std::uint32_t valid = static_cast<std::uint32_t>(masks.leaf[i]) | masks.inner[i];
        const std::uint32_t word = masks.leaf[i] | (valid << 8);
        if (distance <= node::kMaxNearPointer) {
            tree.nodes[i] = word | (distance << node::kPointerShift);
        } else {
            if (tree.farTable.size() > node::kMaxNearPointer)
                return badNode(i, "more than 32768 far pointers");
            tree.nodes[i] = word | node::kFarBit |
                            (static_cast<std::uint32_t>(tree.farTable.size()) << node::kPointerShift);
            tree.farTable.push_back(distance);
        }
    }
    return {};
}

}  // namespace

std::size_t countBranches(const NodeTree& tree) {
    return static_cast<std::size_t>(
        std::ranges::count_if(tree.nodes, [](std::uint32_t d) { return node::innerMask(d) != 0; }));
}

NodePlanes cutPlanes(std::span<const std::uint8_t> bytes, std::size_t nodes, std::size_t branches,
                     bool hoisted) {
    NodePlanes planes;
    planes.inner = bytes.first(nodes);
    planes.branchLeaves = bytes.subspan(nodes, branches);
    planes.hoisted = bytes.subspan(nodes + branches, hoisted ? branches : 0);
    planes.tipLeaves = bytes.subspan(nodes + branches + planes.hoisted.size());
    return planes;
}

std::vector<std::uint8_t> splitPlanes(const NodeTree& tree, std::span<const std::uint32_t> lookup) {
    const bool hoisted = !lookup.empty();
    const std::size_t n = tree.nodes.size();
    const std::size_t m = countBranches(tree);
    std::vector<std::uint8_t> planes(planeBytes(n, m, hoisted));
    std::uint8_t* branchLeaves = planes.data() + n;
    std::uint8_t* hoistedMask = branchLeaves + m;
    std::uint8_t* tipLeaves = hoistedMask + (hoisted ? m : 0);
    for (std::size_t i = 0; i < n; ++i) {
        const std::uint32_t inner = node::innerMask(tree.nodes[i]);
        const auto leaf = static_cast<std::uint8_t>(node::leafMask(tree.nodes[i]));
        planes[i] = static_cast<std::uint8_t>(inner);
        if (inner == 0) {
            *tipLeaves++ = leaf;
            continue;
        }
        *branchLeaves++ = leaf;
        if (hoisted) *hoistedMask++ = static_cast<std::uint8_t>(lookup[i] & inner);
    }
    return planes;
}

Result<void> linkPlanes(const NodePlanes& planes, NodeTree& tree, std::vector<std::uint32_t>* lookup) {
    if (planes.inner.empty()) return fail(ErrorCode::BadStructure, "a tree needs at least its root");
    if (tree.depth == 0 || tree.depth > kMaxTreeDepth) {
        return fail(ErrorCode::BadStructure, fmt::format("a tree of {} levels", tree.depth));
    }
    if (lookup != nullptr && planes.hoisted.size() != planes.branchLeaves.size()) {
        return fail(ErrorCode::BadStructure, "the hoisted plane has another length than the branch plane");
    }
    PFVOX_TRY(const NodeMasks, masks, joinMasks(planes));
    tree.nodes.resize(masks.size());
    PFVOX_CHECK(walkBlocks(masks, tree));
    if (lookup != nullptr) PFVOX_CHECK(linkLookup(masks, planes.hoisted, tree, *lookup));
    return writeDescriptors(masks, tree);
}

}  // namespace pfvox::octree
