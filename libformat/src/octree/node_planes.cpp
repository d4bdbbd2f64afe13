#include "octree/node_planes.hpp"

#include <algorithm>

namespace pfvox::octree {

std::size_t countBranches(const NodeTree& tree) {
    return static_cast<std::size_t>(
        std::ranges::count_if(tree.nodes, [](std::uint32_t d) { return node::innerMask(d) != 0; }));
}

NodePlanes cutPlanes(std::span<const std::uint8_t> bytes, std::size_t nodes, std::size_t branches,
                     bool hoisted) {
    NodePlanes planes;
    planes.inner = bytes.first(nodes);
    planes.branchLeaves = bytes.subspan(nodes, branches);
    planes.hoisted = bytes.subspan(nodes + branches, hoisted ? branches : 0);
    planes.tipLeaves = bytes.subspan(nodes + branches + planes.hoisted.size());
    return planes;
}

std::vector<std::uint8_t> splitPlanes(const NodeTree& tree, std::span<const std::uint32_t> lookup) {
    const bool hoisted = !lookup.empty();
    const std::size_t n = tree.nodes.size();
    const std::size_t m = countBranches(tree);
    std::vector<std::uint8_t> planes(planeBytes(n, m, hoisted));
    std::uint8_t* branchLeaves = planes.data() + n;
    std::uint8_t* hoistedMask = branchLeaves + m;
    std::uint8_t* tipLeaves = hoistedMask + (hoisted ? m : 0);
    for (std::size_t i = 0; i < n; ++i) {
        const std::uint32_t inner = node::innerMask(tree.nodes[i]);
        const auto leaf = static_cast<std::uint8_t>(node::leafMask(tree.nodes[i]));
        planes[i] = static_cast<std::uint8_t>(inner);
        if (inner == 0) {
            *tipLeaves++ = leaf;
            continue;
        }
        *branchLeaves++ = leaf;
        if (hoisted) *hoistedMask++ = static_cast<std::uint8_t>(lookup[i] & inner);
    }
    return planes;
}

}  // namespace pfvox::octree
