// NodePlanes: a tree of child descriptors without anything that can be computed.
//
// Because nodes lie in depth-first order of sibling blocks, pointers, far table and lookup words follow from
// the masks alone. A packed PF_VOX file stores just these, plane by plane (docs/format-pf_vox.md, "MASK"):
//     valid[n]    the valid mask of every node
//     inner[n]    valid & ~leaf of every node
//     hoisted[m]  for the nodes with inner != 0, in order: the inner children whose whole subtree has one
//     value
#pragma once

#include <cstdint>
#include <pfvox/error.hpp>
#include <pfvox/octree.hpp>
#include <span>
#include <vector>

namespace pfvox::octree {

struct NodePlanes {
    std::span<const std::uint8_t> valid;
    std::span<const std::uint8_t> inner;
    std::span<const std::uint8_t> hoisted;  ///< empty for a top tree
};

/// Number of nodes with inner children: the length of the hoisted plane.
std::size_t countInnerNodes(const NodeTree& tree);

/// Writes valid, inner and, with `lookup`, hoisted, one behind the other.
std::vector<std::uint8_t> splitPlanes(const NodeTree& tree, std::span<const std::uint32_t> lookup);

/// Rebuilds `tree` (whose depth is given) and, when not null, the lookup words. Everything in the planes is
/// untrusted. Errors: BadStructure with the index of the node as offset in the plane.
Result<void> linkPlanes(const NodePlanes& planes, NodeTree& tree, std::vector<std::uint32_t>* lookup);

}  // namespace pfvox::octree
