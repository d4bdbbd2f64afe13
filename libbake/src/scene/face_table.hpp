// Where the light of faces is found from a hit: the faces of a model (FaceIndex) beside its wide nodes, as
// shared/faces.glsl.h has them.
#pragma once

#include <pfvox/face_index.hpp>
#include <vector>

#include "scene/wide_tree.hpp"

namespace pfvox::gpu::detail {

/// A node with faces, for the means of levels of detail. In post-order: children before their parent.
struct FaceNode {
    std::uint32_t slot = 0;
    std::uint32_t children = 0;   ///< the last so many nodes that are nobody's yet; 0 = it has faces itself
    std::uint32_t firstFace = 0;  ///< of a node that has them itself
    std::uint32_t squares = 0;    ///< slots a direction of a large leaf; 0 = a mask each
    std::uint32_t directions = 0;
};

struct FaceTable {
    FaceIndex index;
    std::vector<glm::uvec2> cells;  ///< a wide node
    std::vector<glm::uvec2> slots;  ///< masks, low word first, and squares of large leaves
    std::vector<FaceNode> nodes;
};

/// Errors: GpuOutOfMemory (2^26 slots or more).
Result<FaceTable> makeFaceTable(const OctreeModel& model, const WideTree& tree, FaceIndex index);

}  // namespace pfvox::gpu::detail
