#include "scene/wide_tree.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <pfvox/assert.hpp>
#include <pfvox/octree_walk.hpp>
#include <span>

#include "scene/wide_region.hpp"

namespace pfvox::gpu::detail {

namespace {

using shared::WideNode;

/// The mean of what the cells look like: what stands for nodes above the regions.
glm::uvec2 meanLod(std::span<const glm::uvec2> cells) {
    glm::uvec4 sum(0);
    glm::uvec2 most(0);
    for (const glm::uvec2 cell : cells) {
        const std::uint32_t coverage = cell.x >> 24;
        for (int channel = 0; channel < 3; ++channel)
            sum[channel] += coverage * (cell.x >> (8 * channel) & 0xffu);
        sum.w += coverage;
        if (coverage > most.x >> 24) most = cell;
    }
    if (sum.w == 0) return {0, 0};
    const std::uint32_t covered = (sum.w + 63) / 64;
    return {sum.x / sum.w | sum.y / sum.w << 8 | sum.z / sum.w << 16 | covered << 24, most.y};
}

/// Joins the regions' roots under the top tree.
class TopWidener {
  public:
    TopWidener(const OctreeModel& model, std::span<const WideRoot> roots, WidePiece& out)
        : model_(model), roots_(roots), out_(out) {}

    void run() {
        out_.nodes.resize(1);
        out_.lods.resize(1);
        const std::uint32_t depth = model_.topTree.depth;
        if (depth == 0) {
            put(0, roots_[0]);
        } else if (depth % 2 == 0) {
            put(0, join(cellsOf(0)));
        } else {  // a level above the root, of which only the first child exists
            std::array<Cell, 64> cells{};
            addChildren(0, 0, cells);
            put(0, join(cells));
        }
    }

  private:
    enum class CellKind : std::uint8_t { Empty, Inner, Region };
    struct Cell {
        CellKind kind = CellKind::Empty;
        std::uint32_t index = 0;
    };

    void put(std::size_t at, const WideRoot& root) {
        out_.nodes[at] = root.node;
        out_.lods[at] = root.lod;
    }

    Cell childOf(std::uint32_t index, std::uint32_t slot) const {
        const std::optional<NodeChild> child = childAt(model_.topTree, index, slot);
        if (!child) return {};
        if (child->isLeaf) return {CellKind::Region, model_.topFirstRegion[index] + child->index};
        return {CellKind::Inner, child->index};
    }

    void addChildren(std::uint32_t index, std::uint32_t slot, std::array<Cell, 64>& cells) const {
        for (std::uint32_t sub = 0; sub < 8; ++sub) cells[wideCell(slot, sub)] = childOf(index, sub);
    }

    std::array<Cell, 64> cellsOf(std::uint32_t index) const {
        std::array<Cell, 64> cells{};
        for (std::uint32_t slot = 0; slot < 8; ++slot) {
            const Cell child = childOf(index, slot);
            // Region leaves are all on one level, an even number of levels above the deepest cells.
            PFVOX_ASSERT(child.kind != CellKind::Region);
            if (child.kind == CellKind::Inner) addChildren(child.index, slot, cells);
        }
        return cells;
    }

    WideRoot join(const std::array<Cell, 64>& cells) {
        std::uint64_t mask = 0;
        for (std::size_t k = 0; k < 64; ++k)
            if (cells[k].kind != CellKind::Empty) mask |= std::uint64_t{1} << k;
        const std::size_t first = out_.nodes.size();
        const auto count = static_cast<std::size_t>(std::popcount(mask));
        out_.nodes.resize(first + count);
        out_.lods.resize(first + count);
        std::size_t at = first;
        for (const Cell& cell : cells) {
            if (cell.kind == CellKind::Empty) continue;
            put(at++, cell.kind == CellKind::Region ? roots_[cell.index] : join(cellsOf(cell.index)));
        }
        return {innerNode(mask, static_cast<std::uint32_t>(first)),
                meanLod(std::span(out_.lods).subspan(first, count))};
    }

    const OctreeModel& model_;
    std::span<const WideRoot> roots_;
    WidePiece& out_;
};

/// Makes the indices of a node count in the whole model.
void move(WideNode& node, const WidePlace& place) {
    switch (node.kind & shared::kWideKindMask) {
        case shared::kWideInner:
            node.child += static_cast<std::uint32_t>(place.firstNode);
            break;
        case shared::kWideBrick: {
            const std::uint64_t perValue = (node.kind & shared::kWideShortValues) != 0 ? 2 : 1;
            node.child += static_cast<std::uint32_t>(place.firstValueByte / perValue);
            node.kind += static_cast<std::uint32_t>(place.firstPaletteEntry << shared::kWidePaletteShift);
            break;
        }
        default:
            break;  // the material itself
    }
}

void place(WideTree& tree) {
    for (const WidePiece& piece : tree.pieces) {
        tree.places.push_back(tree.end);
        tree.end.firstNode += piece.nodes.size();
        tree.end.firstValueByte += piece.values.size();
        tree.end.firstPaletteEntry += piece.palette.size();
    }
}

bool fits(const WidePlace& end) {
    return end.firstNode <= 0xffffffffu && end.firstValueByte <= 0xffffffffu &&
           end.firstPaletteEntry < (1u << (32 - shared::kWidePaletteShift));
}

}  // namespace

Result<WideTree> widen(const OctreeModel& model, std::uint32_t firstMaterial) {
    const std::size_t count = model.regions.size();
    WideTree tree;
    tree.levels = wideLevels(model.depth);
    tree.hasLods = std::ranges::none_of(model.regions, [](const OctreeRegion& r) { return r.lod.empty(); });
    tree.pieces.resize(count + 1);
    std::vector<WideRoot> roots;
    roots.resize(count);
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
        roots[i] = widenRegion(model.regions[i], {firstMaterial, tree.hasLods}, tree.pieces[1 + i]);
    });

    // The top comes first and holds the regions' roots: made once for its size, and again with roots that
    // know it.
    WidePiece& top = tree.pieces[0];
    TopWidener(model, roots, top).run();
    place(tree);
    if (!fits(tree.end)) {
        return fail(ErrorCode::GpuOutOfMemory, "model '" + model.name.str() +
                                                   "' has more nodes or voxels than one "
                                                   "model on the GPU can have");
    }
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
        for (WideNode& node : tree.pieces[1 + i].nodes) move(node, tree.places[1 + i]);
        move(roots[i].node, tree.places[1 + i]);
    });
    top = {};
    TopWidener(model, roots, top).run();
    if (!tree.hasLods) top.lods.clear();
    return tree;
}

}  // namespace pfvox::gpu::detail
