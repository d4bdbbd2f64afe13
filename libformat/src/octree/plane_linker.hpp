// PlaneLinker: from the planes of masks (node_planes.hpp) back to child descriptors and lookup words.
//
// Three passes: over the planes, node by node, for the masks; over the nodes with inner children, depth
// first, for pointers and for what lies below hoisted values; over the masks of values, eight nodes at once,
// for value pointers. Each word of the result is in the cache when it is written a second time.
#pragma once

#include <cstdint>
#include <pfvox/error.hpp>
#include <pfvox/octree.hpp>
#include <span>
#include <vector>

#include "octree/grow_buffer.hpp"
#include "octree/node_planes.hpp"

namespace pfvox::octree {

/// Reusable by one thread for many trees; keeps its buffers.
class PlaneLinker {
  public:
    /// Rebuilds `tree`, whose depth is given. Everything in the planes is untrusted.
    /// Errors: BadStructure with the index of the node as offset in the plane.
    Result<void> linkTree(const NodePlanes& planes, NodeTree& tree);

    /// The same with the lookup words; returns the number of values.
    Result<std::uint64_t> linkRegion(const NodePlanes& planes, NodeTree& tree,
                                     PooledVector<std::uint32_t>& lookup);

  private:
    struct FarPointer {
        std::uint32_t node;
        std::uint32_t distance;
    };

    Result<void> joinMasks(const NodePlanes& planes, std::uint32_t* nodes);
    Result<void> walk(std::span<const std::uint8_t> inner, NodeTree& tree);
    bool coverBlock(std::uint64_t innerMasks, std::uint32_t first, std::uint32_t count,
                    std::uint32_t covered);
    Result<void> writeFarTable(NodeTree& tree);

    GrowBuffer<std::uint8_t> buffer_;
    std::uint8_t* masks_ = nullptr;  ///< in buffer_: slots of each node that carry a value, and eight zeros
    std::size_t size_ = 0;           ///< nodes
    std::vector<FarPointer> far_;
};

}  // namespace pfvox::octree
