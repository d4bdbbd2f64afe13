// A walk over the leaves of an octree region: what turns octrees into other grids.
#pragma once

#include <bit>
#include <pfvox/assert.hpp>
#include <pfvox/octree.hpp>
#include <vector>

namespace pfvox {

/// Set bits of `mask` below bit `slot`: the position of a slot's entry among those of its node.
inline std::uint32_t countBelow(std::uint32_t mask, std::uint32_t slot) {
    return static_cast<std::uint32_t>(std::popcount(mask & ((1u << slot) - 1)));
}

/// Calls visit(cornerInRegion, edgeLog2, material) for every leaf; no empty regions.
template <class Visit>
void forEachLeaf(const OctreeRegion& region, const Visit& visit) {
    struct Frame {
        std::uint32_t index;
        std::uint32_t level;  ///< edge of the node's children = 2^level
        glm::ivec3 corner;
        std::uint32_t value;  ///< hoisted value in force, kNone without
    };
    constexpr std::uint32_t kNone = 0xffffffffu;
    std::vector<Frame> stack{{0, region.tree.depth - 1, glm::ivec3{0}, kNone}};
    while (!stack.empty()) {
        const Frame f = stack.back();
        stack.pop_back();
        const std::uint32_t d = region.tree.nodes[f.index];
        const std::uint32_t lookup = region.lookup[f.index];
        for (std::uint32_t slot = 0; slot < 8; ++slot) {
            if (((node::validMask(d) >> slot) & 1u) == 0) continue;
            const glm::ivec3 corner = f.corner + glm::ivec3{mortonDecode(slot)} * (1 << f.level);
            const std::uint32_t value =
                ((lookup >> slot) & 1u) != 0 ? (lookup >> 8) + countBelow(lookup & 0xffu, slot) : f.value;
            if (((node::leafMask(d) >> slot) & 1u) != 0) {
                PFVOX_ASSERT(value != kNone);
                visit(corner, f.level, region.palette[region.value(value)]);
            } else {
                const std::uint32_t child =
                    region.tree.firstChild(f.index) + countBelow(node::innerMask(d), slot);
                stack.push_back({child, f.level - 1, corner, value});
            }
        }
    }
}

}  // namespace pfvox
