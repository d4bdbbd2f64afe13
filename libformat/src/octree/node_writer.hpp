// NodeWriter: puts a tree of child descriptors together from its leaves up.
//
// Final order is depth-first by sibling blocks, so a node's children lie behind it. Writing that order
// backwards means that everything a descriptor points at is already written when the descriptor is: no
// fix-ups, no second traversal. writeTree() and writeAttributes() turn the sequence round and make pointers,
// far table, lookup words and the palette in linear passes.
#pragma once

#include <array>
#include <cstdint>
#include <pfvox/error.hpp>
#include <pfvox/octree.hpp>
#include <vector>

#include "octree/grow_buffer.hpp"

namespace pfvox::octree {

/// What a parent knows about one of its child slots.
struct Slot {
    enum class Kind : std::uint8_t { Empty, Leaf, Inner };

    Kind kind = Kind::Empty;
    bool uniform = false;        ///< everything solid below has one material: `material`
    MaterialIndex material = 0;  ///< of a leaf, or of a uniform inner child
    // Of an inner child:
    std::uint8_t validMask = 0;
    std::uint8_t leafMask = 0;
    std::uint8_t valueMask = 0;             ///< its slots that carry a value if it is not uniform itself
    std::uint32_t firstChild = 0;           ///< position of its first inner child in the backward sequence
    std::array<MaterialIndex, 8> values{};  ///< material by slot, where valueMask is set

    static Slot leaf(MaterialIndex m) { return {.kind = Kind::Leaf, .uniform = true, .material = m}; }
};

class NodeWriter {
  public:
    /// Makes the parent of eight children: a larger leaf when all are leaves of one material, else an inner
    /// node whose block of inner children is written now. Children's subtrees must have been written from
    /// slot 7 to slot 0.
    Slot combine(const std::array<Slot, 8>& children);

    /// The same for 4^3 voxels with their mask and materials in Morton order. Three nodes of four are made
    /// here.
    Slot combineVoxels(std::uint64_t occupancy, const MaterialIndex* materials);

    /// Ends the tree with its root, which must not be Empty. A root that is one leaf is written as a node of
    /// eight.
    void finish(const Slot& root);

    /// While the root has one inner child only, that child becomes the root; a root with one leaf child
    /// becomes that leaf's eight octants. Call after finish(). Returns the slots that were descended through.
    std::vector<std::uint32_t> stripRoot(std::uint32_t maxLevels);

    /// Nodes and far table in final order. Errors: LimitExceeded if the far table would exceed 2^15 entries.
    Result<void> writeTree(NodeTree& tree) const;
    /// Lookup words, values and palette in final order. Errors: BadReference for a material >= materialCount.
    Result<void> writeAttributes(std::size_t materialCount, OctreeRegion& region) const;

    void clear();

  private:
    /// A node in the backward sequence.
    struct Record {
        std::uint32_t distance;  ///< to the first inner child, in nodes; 0 without one
        std::uint8_t leafMask;
        std::uint8_t validMask;
        std::uint8_t valueMask;
        std::uint8_t valueCount;
    };
    void push(const Slot& node, std::uint8_t valueMask);

    GrowBuffer<Record> records_;
    GrowBuffer<MaterialIndex> values_;
};

}  // namespace pfvox::octree
