// NodePlanes: a tree of child descriptors without anything that can be computed.
//
// Because nodes lie in depth-first order of sibling blocks, pointers, far table and lookup words follow from
// the masks alone. A packed PF_VOX file stores just these, as four planes, one behind the other
// (docs/format-pf_vox.md, "MASK"). Of n nodes, m have inner children ("branches"), the others only leaves:
//     inner[n]          valid & ~leaf of every node; 0 tells a node without inner children
//     branchLeaves[m]   the leaf mask of each branch
//     hoisted[m]        the inner children of each branch whose whole subtree has one value (not in a top
//     tree) tipLeaves[n - m]  the leaf mask of each node without inner children
// Masks of one kind side by side compress better than mixed: 0.27 instead of 0.28 bytes a voxel on a thin
// shell.
#pragma once

#include <cstdint>
#include <pfvox/octree.hpp>
#include <span>
#include <vector>

namespace pfvox::octree {

struct NodePlanes {
    std::span<const std::uint8_t> inner;
    std::span<const std::uint8_t> branchLeaves;
    std::span<const std::uint8_t> hoisted;  ///< empty in a top tree
    std::span<const std::uint8_t> tipLeaves;
};

/// Cuts a MASK section into its planes. Precondition: bytes.size() == planeBytes(nodes, branches, hoisted).
NodePlanes cutPlanes(std::span<const std::uint8_t> bytes, std::size_t nodes, std::size_t branches,
                     bool hoisted);

constexpr std::uint64_t planeBytes(std::uint64_t nodes, std::uint64_t branches, bool hoisted) {
    return 2 * nodes + (hoisted ? branches : 0);
}

/// Number of nodes with inner children.
std::size_t countBranches(const NodeTree& tree);

/// The planes of a tree; with the hoisted one if `lookup` is not empty.
std::vector<std::uint8_t> splitPlanes(const NodeTree& tree, std::span<const std::uint32_t> lookup);

}  // namespace pfvox::octree
