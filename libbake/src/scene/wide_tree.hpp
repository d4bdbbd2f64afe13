// One model's octree in the form that the GPU traverses: two levels at a time, 4^3 cells a node
// (docs/decisions/012-wide-tree.md).
//
//     OctreeModel -> [widen] -> WideTree -> device memory
//
// Half the loads of a walk down, fewer and larger steps across empty space, and less memory than the child
// descriptors with their lookup take.
#pragma once

#include <cstddef>
#include <cstdint>
#include <pfvox/octree.hpp>
#include <vector>

#include "shared/scene.glsl.h"

namespace pfvox::gpu::detail {

/// Nodes and what their indices refer to.
struct WidePiece {
    std::vector<shared::WideNode> nodes;
    std::vector<glm::uvec2> lods;        ///< for each node, see ModelRecord::lods; empty without
    std::vector<std::uint8_t> values;    ///< padded to whole words
    std::vector<std::uint32_t> palette;  ///< materials of the scene
};

/// Where a piece begins in the arrays of its model.
struct WidePlace {
    std::uint64_t firstNode = 0;
    std::uint64_t firstValueByte = 0;  ///< a multiple of 4
    std::uint64_t firstPaletteEntry = 0;
};

/// A model in as many pieces as it has regions, behind one that joins them. Indices count in the arrays of
/// the whole model: the pieces' arrays one after the other, as `places` says.
struct WideTree {
    std::uint32_t levels = 1;  ///< the root spans 4^levels voxels
    bool hasLods = false;
    std::vector<WidePiece>
        pieces;  ///< the first holds the root and all above the regions' roots, these included
    std::vector<WidePlace> places;
    WidePlace end;  ///< counts of the whole model

    std::uint64_t nodeBytes() const { return sizeof(shared::WideNode) * end.firstNode; }
    std::uint64_t lodBytes() const { return hasLods ? sizeof(glm::uvec2) * end.firstNode : 0; }
    std::uint64_t valueBytes() const { return end.firstValueByte; }
    std::uint64_t paletteBytes() const { return 4 * end.firstPaletteEntry; }
};

/// The number of wide levels for an octree of that depth.
constexpr std::uint32_t wideLevels(std::uint32_t depth) {
    return depth == 0 ? 1 : (depth + 1) / 2;
}

/// Regions are widened in parallel in the calling TBB arena. `firstMaterial` is added to all materials: a
/// scene joins those of its assets. Precondition: the model has a region. Errors: GpuOutOfMemory when an
/// index does not fit its field (32 bits, 29 for palettes).
Result<WideTree> widen(const OctreeModel& model, std::uint32_t firstMaterial);

}  // namespace pfvox::gpu::detail
