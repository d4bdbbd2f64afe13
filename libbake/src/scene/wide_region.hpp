// One region of an octree as wide nodes: a part of wide_tree.hpp.
#pragma once

#include <bit>
#include <cstdint>
#include <pfvox/octree.hpp>

#include "scene/wide_tree.hpp"

namespace pfvox::gpu::detail {

/// A node whose place is in the list of whatever stands above.
struct WideRoot {
    shared::WideNode node{};
    glm::uvec2 lod{0};
};

struct WidenSettings {
    std::uint32_t firstMaterial = 0;
    bool lods = false;
};

/// The wide cell of child slot `sub` within child slot `slot`.
constexpr std::uint32_t wideCell(std::uint32_t slot, std::uint32_t sub) {
    const auto axis = [&](std::uint32_t bit) { return 2 * (slot >> bit & 1u) + (sub >> bit & 1u); };
    return axis(0) + 4 * axis(1) + 16 * axis(2);
}

inline shared::WideNode innerNode(std::uint64_t mask, std::uint32_t firstChild) {
    return {.maskLow = static_cast<std::uint32_t>(mask),
            .maskHigh = static_cast<std::uint32_t>(mask >> 32),
            .child = firstChild,
            .kind = shared::kWideInner};
}

/// Appends all nodes but the root to `out`; their indices count from the start of its arrays.
WideRoot widenRegion(const OctreeRegion& region, const WidenSettings& settings, WidePiece& out);

}  // namespace pfvox::gpu::detail
