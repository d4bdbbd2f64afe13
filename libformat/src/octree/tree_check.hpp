// TreeCheck: whether child descriptors and lookup words from a file that is not trusted are those that their
// masks give.
//
// The order of nodes leaves no choice: masks decide every pointer, the far table and the value pointers
// (node_planes.hpp computes them). So the words of a resident PF_VOX file are right exactly if they are what
// PlaneLinker would make from their masks; this compares without making a second tree.
#pragma once

#include <pfvox/error.hpp>
#include <pfvox/octree.hpp>
#include <span>

namespace pfvox::octree {

/// Afterwards every pointer is inside and forward, every node is reached exactly once, no path is longer than
/// tree.depth and no far entry is unused. Errors: BadStructure with the index of the node as offset.
Result<void> checkTree(const NodeTree& tree);

/// Precondition: checkTree(tree) found nothing. Afterwards every leaf has one value, its own or that of one
/// ancestor, and value pointers are the sums that they must be. Returns the number of values. Errors: as
/// checkTree.
Result<std::uint64_t> checkLookup(const NodeTree& tree, std::span<const std::uint32_t> lookup);

}  // namespace pfvox::octree
