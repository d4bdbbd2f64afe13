// A bounding volume hierarchy over boxes, built with the binned surface area heuristic (Wald 2007, "On fast
// Construction of SAH-based Bounding Volume Hierarchies").
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <span>
#include <vector>

#include "shared/scene.glsl.h"

namespace pfvox::gpu::detail {

struct Box {
    glm::vec3 min{std::numeric_limits<float>::infinity()};
    glm::vec3 max{-std::numeric_limits<float>::infinity()};

    void include(const Box& other) {
        min = glm::min(min, other.min);
        max = glm::max(max, other.max);
    }
    void include(glm::vec3 point) {
        min = glm::min(min, point);
        max = glm::max(max, point);
    }
    /// Half of the surface: all that comparisons need.
    float halfArea() const {
        const glm::vec3 e = glm::max(max - min, glm::vec3(0.0f));
        return e.x * e.y + e.y * e.z + e.z * e.x;
    }
    glm::vec3 center() const { return 0.5f * (min + max); }
};

struct Bvh {
    std::vector<shared::BvhNode> nodes;  ///< node 0 is the root; the two children of a node are neighbors
    std::vector<std::uint32_t> order;    ///< leaves refer to ranges of this permutation of the boxes
};

/// Depth is below shared::kBvhStackSize for any input. No boxes give no nodes.
Bvh buildBvh(std::span<const Box> boxes);

}  // namespace pfvox::gpu::detail
