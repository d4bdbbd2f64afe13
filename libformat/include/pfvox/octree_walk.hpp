// Walks over octrees: what a node's words say about its children is known here and nowhere else.
//
//     OctreeModel -> [forEachLeaf, forEachExposedFace] -> cubes and faces of one material, in model voxels
#pragma once

#include <bit>
#include <cstdint>
#include <functional>
#include <optional>
#include <pfvox/assert.hpp>
#include <pfvox/octree.hpp>
#include <vector>

namespace pfvox {

/// Set bits of `mask` below bit `slot`: how many entries of its kind come before that of a slot.
constexpr std::uint32_t countBelow(std::uint32_t mask, std::uint32_t slot) {
    return static_cast<std::uint32_t>(std::popcount(mask & ((1u << slot) - 1)));
}

/// Lower corner of a child slot in its parent, in edges of the child.
constexpr glm::ivec3 cornerOfSlot(std::uint32_t slot) {
    return {static_cast<int>(slot & 1u), static_cast<int>(slot >> 1 & 1u), static_cast<int>(slot >> 2)};
}

struct NodeChild {
    std::uint32_t slot = 0;   ///< x + 2y + 4z
    bool isLeaf = false;      ///< of a top tree: a region
    std::uint32_t index = 0;  ///< of its node; of a leaf, how many leaves its parent has before it
};

/// Nothing where the slot is empty.
inline std::optional<NodeChild> childAt(const NodeTree& tree, std::uint32_t node, std::uint32_t slot) {
    const std::uint32_t d = tree.nodes[node];
    if ((node::validMask(d) >> slot & 1u) == 0) return std::nullopt;
    if ((node::leafMask(d) >> slot & 1u) != 0)
        return NodeChild{slot, true, countBelow(node::leafMask(d), slot)};
    return NodeChild{slot, false, tree.firstChild(node) + countBelow(node::innerMask(d), slot)};
}

/// Calls visit(NodeChild) for the children that exist, in slot order.
template <class Visit>
void forEachChild(const NodeTree& tree, std::uint32_t node, const Visit& visit) {
    const std::uint32_t d = tree.nodes[node];
    std::uint32_t inner = node::innerMask(d) != 0 ? tree.firstChild(node) : 0;
    std::uint32_t leaves = 0;
    for (std::uint32_t rest = node::validMask(d); rest != 0; rest &= rest - 1) {
        const auto slot = static_cast<std::uint32_t>(std::countr_zero(rest));
        const bool isLeaf = (node::leafMask(d) >> slot & 1u) != 0;
        visit(NodeChild{slot, isLeaf, isLeaf ? leaves++ : inner++});
    }
}

/// Of a node above which nothing is hoisted, or of an inner child whose subtree has several materials.
inline constexpr std::uint32_t kNoValue = 0xffffffffu;

/// The palette index that holds for a child: its own, else the one that holds for its parent. Precondition:
/// the slot exists.
inline std::uint32_t childValue(const OctreeRegion& region, std::uint32_t node, std::uint32_t slot,
                                std::uint32_t inherited) {
    const std::uint32_t lookup = region.lookup[node];
    if ((lookup >> slot & 1u) == 0) return inherited;
    return region.value((lookup >> 8) + countBelow(lookup & 0xffu, slot));
}

/// Calls visit(NodeChild, palette index) for the children that exist; `inherited` holds for the node itself.
template <class Visit>
void forEachChild(const OctreeRegion& region, std::uint32_t node, std::uint32_t inherited,
                  const Visit& visit) {
    const std::uint32_t lookup = region.lookup[node];
    std::uint32_t next = lookup >> 8;  // values stand in slot order too
    forEachChild(region.tree, node, [&](const NodeChild& child) {
        visit(child, (lookup >> child.slot & 1u) != 0 ? region.value(next++) : inherited);
    });
}

/// A leaf of a region's octree: a cube of one material.
struct Leaf {
    glm::ivec3 corner{0};        ///< model voxels
    std::uint32_t edgeLog2 = 0;  ///< its edge is 2^edgeLog2 voxels
    MaterialIndex material = 0;

    int edge() const { return 1 << edgeLog2; }
};

/// Calls visit(Leaf) for every leaf, in the order of nodes and slots; nothing for an empty region.
template <class Visit>
void forEachLeaf(const OctreeRegion& region, const Visit& visit) {
    const auto walk = [&](const auto& self, std::uint32_t node, glm::ivec3 corner, std::uint32_t childLog2,
                          std::uint32_t inherited) -> void {
        forEachChild(region, node, inherited, [&](const NodeChild& child, std::uint32_t value) {
            const glm::ivec3 at = corner + (cornerOfSlot(child.slot) << static_cast<int>(childLog2));
            if (!child.isLeaf) return self(self, child.index, at, childLog2 - 1, value);
            PFVOX_ASSERT(value != kNoValue);
            visit(Leaf{.corner = at, .edgeLog2 = childLog2, .material = region.palette[value]});
        });
    };
    if (!region.tree.nodes.empty()) walk(walk, 0, region.originVoxels, region.tree.depth - 1, kNoValue);
}

/// A face of a voxel: 0..5 = -x +x -y +y -z +z.
struct VoxelFace {
    glm::ivec3 voxel{0};
    int face = 0;
    MaterialIndex material = 0;

    int axis() const { return face / 2; }
    bool isUpper() const { return face % 2 != 0; }
};

/// By material of the asset, one entry each.
struct FaceFilter {
    std::vector<bool> wanted;  ///< faces of these voxels
    std::vector<bool> hides;   ///< that touch none of these
};

/// Calls `visit` for each wanted face whose neighbor is empty or does not hide it; always in the same order.
/// Takes 2 MB and time by the surface of leaves, not by their volume.
void forEachExposedFace(const OctreeModel& model, const FaceFilter& filter,
                        const std::function<void(const VoxelFace&)>& visit);

}  // namespace pfvox
