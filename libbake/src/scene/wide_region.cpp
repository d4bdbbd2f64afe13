#include "scene/wide_region.hpp"

#include <array>
#include <optional>
#include <pfvox/assert.hpp>
#include <pfvox/octree_walk.hpp>

namespace pfvox::gpu::detail {

namespace {

using shared::WideNode;

constexpr std::uint64_t kAllCells = ~std::uint64_t{0};

/// Child masks spread over the wide cells of slot 0; the other slots' are these, shifted.
constexpr std::array<std::uint64_t, 256> makeSpread() {
    std::array<std::uint64_t, 256> table{};
    for (std::uint32_t mask = 0; mask < 256; ++mask)
        for (std::uint32_t sub = 0; sub < 8; ++sub)
            if ((mask >> sub & 1u) != 0) table[mask] |= std::uint64_t{1} << wideCell(0, sub);
    return table;
}
constexpr std::array<std::uint64_t, 256> kSpread = makeSpread();

constexpr std::array<std::uint8_t, 64> makeCells() {
    std::array<std::uint8_t, 64> table{};
    for (std::uint32_t slot = 0; slot < 8; ++slot)
        for (std::uint32_t sub = 0; sub < 8; ++sub)
            table[8 * slot + sub] = static_cast<std::uint8_t>(wideCell(slot, sub));
    return table;
}
constexpr std::array<std::uint8_t, 64> kCells = makeCells();

/// Values are palette indices throughout; kNoValue = not known yet, it stands further down.
class RegionWidener {
  public:
    RegionWidener(const OctreeRegion& region, const WidenSettings& settings, WidePiece& out)
        : region_(region), settings_(settings), out_(out) {
        for (const MaterialIndex material : region.palette)
            out_.palette.push_back(settings.firstMaterial + material);
        out_.values.reserve(region.values.size());
    }

    WideRoot run() {
        const std::uint32_t depth = region_.tree.depth;
        if (depth % 2 == 0) return node({0, kNoValue}, depth);
        // A level above the root, of which only the first child exists.
        if (depth == 1)
            return brick([&](Voxels& voxels) { addVoxels({0, kNoValue}, 0, voxels); }, std::nullopt);
        Cells cells;
        addChildren({0, kNoValue}, 0, cells);
        return inner(cells, depth - 1, std::nullopt);
    }

  private:
    /// An octree node, and the value that is hoisted above it.
    struct Source {
        std::uint32_t index = 0;
        std::uint32_t value = kNoValue;
    };
    struct Cells {
        std::uint64_t inner = 0;
        std::uint64_t leaves = 0;
        std::array<Source, 64> at;  ///< of a leaf, only the value counts
    };
    struct Voxels {
        std::uint64_t mask = 0;
        std::array<std::uint16_t, 64> values;
    };

    glm::uvec2 lodOf(std::optional<std::uint32_t> index) const {
        if (!settings_.lods || !index) return {0, 0};
        return {region_.lod.colors[*index], out_.palette[region_.lod.materials[*index]]};
    }

    // --- Nodes of 4^3 voxels ---

    void addVoxels(Source source, std::uint32_t slot, Voxels& voxels) const {
        const std::uint32_t valid = node::validMask(region_.tree.nodes[source.index]);
        voxels.mask |= kSpread[valid] << wideCell(slot, 0);
        forEachChild(region_, source.index, source.value, [&](const NodeChild& child, std::uint32_t value) {
            voxels.values[kCells[8 * slot + child.slot]] = static_cast<std::uint16_t>(value);
        });
    }

    void addVoxelsOfNode(Source source, Voxels& voxels) const {
        forEachChild(region_, source.index, source.value, [&](const NodeChild& child, std::uint32_t value) {
            if (!child.isLeaf) return addVoxels({child.index, value}, child.slot, voxels);
            voxels.mask |= kSpread[0xff] << wideCell(child.slot, 0);
            for (std::uint32_t sub = 0; sub < 8; ++sub)
                voxels.values[kCells[8 * child.slot + sub]] = static_cast<std::uint16_t>(value);
        });
    }

    /// The masks alone, for what has one value.
    std::uint64_t maskOf(std::uint32_t index) const {
        std::uint64_t mask = 0;
        forEachChild(region_.tree, index, [&](const NodeChild& child) {
            const std::uint32_t valid =
                child.isLeaf ? 0xffu : node::validMask(region_.tree.nodes[child.index]);
            mask |= kSpread[valid] << wideCell(child.slot, 0);
        });
        return mask;
    }

    template <class Gather>
    WideRoot brick(const Gather& gather, std::optional<std::uint32_t> index) {
        Voxels voxels;
        gather(voxels);
        const std::uint16_t first = voxels.values[static_cast<std::size_t>(std::countr_zero(voxels.mask))];
        const std::size_t start = out_.values.size();
        bool same = true;
        const bool wide = region_.valueBytes() == 2;
        for (std::uint64_t rest = voxels.mask; rest != 0; rest &= rest - 1) {
            const std::uint16_t value = voxels.values[static_cast<std::size_t>(std::countr_zero(rest))];
            same &= value == first;
            out_.values.push_back(static_cast<std::uint8_t>(value));
            if (wide) out_.values.push_back(static_cast<std::uint8_t>(value >> 8));
        }
        WideNode made = innerNode(voxels.mask, 0);
        if (same) {
            out_.values.resize(start);
            made.kind = shared::kWideUniform;
            made.child = out_.palette[first];
        } else {
            made.kind = shared::kWideBrick | (wide ? shared::kWideShortValues : 0);
            made.child = static_cast<std::uint32_t>(wide ? start / 2 : start);
        }
        return {made, lodOf(index)};
    }

    // --- Nodes above ---

    void addChildren(Source source, std::uint32_t slot, Cells& cells) const {
        const std::uint32_t d = region_.tree.nodes[source.index];
        const std::uint32_t shift = wideCell(slot, 0);
        cells.leaves |= kSpread[node::leafMask(d)] << shift;
        cells.inner |= kSpread[node::innerMask(d)] << shift;
        forEachChild(region_, source.index, source.value, [&](const NodeChild& child, std::uint32_t value) {
            cells.at[kCells[8 * slot + child.slot]] = {child.index, value};
        });
    }

    void addCellsOfNode(Source source, Cells& cells) const {
        forEachChild(region_, source.index, source.value, [&](const NodeChild& child, std::uint32_t value) {
            if (!child.isLeaf) return addChildren({child.index, value}, child.slot, cells);
            cells.leaves |= kSpread[0xff] << wideCell(child.slot, 0);
            for (std::uint32_t sub = 0; sub < 8; ++sub) cells.at[kCells[8 * child.slot + sub]] = {0, value};
        });
    }

    WideRoot solid(std::uint32_t value) const {
        PFVOX_ASSERT(value != kNoValue);
        const std::uint32_t material = out_.palette[value];
        WideNode made = innerNode(kAllCells, material);
        made.kind = shared::kWideSolid;
        return {made, {0, material}};  // its color is that of its material: never asked for
    }

    /// `level`: the cells have an edge of 2^level voxels.
    WideRoot inner(const Cells& cells, std::uint32_t level, std::optional<std::uint32_t> index) {
        const std::uint64_t mask = cells.inner | cells.leaves;
        const std::size_t first = out_.nodes.size();
        const auto count = static_cast<std::size_t>(std::popcount(mask));
        out_.nodes.resize(first + count);
        if (settings_.lods) out_.lods.resize(first + count);
        std::size_t at = first;
        for (std::uint64_t rest = mask; rest != 0; rest &= rest - 1, ++at) {
            const auto k = static_cast<std::size_t>(std::countr_zero(rest));
            const bool leaf = (cells.leaves >> k & 1u) != 0;
            const WideRoot made = leaf ? solid(cells.at[k].value) : node(cells.at[k], level);
            out_.nodes[at] = made.node;
            if (settings_.lods) out_.lods[at] = made.lod;
        }
        return {innerNode(mask, static_cast<std::uint32_t>(first)), lodOf(index)};
    }

    /// The wide node of an octree node with an edge of 2^level voxels, level even.
    WideRoot node(Source source, std::uint32_t level) {
        if (level > 2) {
            Cells cells;
            addCellsOfNode(source, cells);
            return inner(cells, level - 2, source.index);
        }
        if (source.value == kNoValue)
            return brick([&](Voxels& voxels) { addVoxelsOfNode(source, voxels); }, source.index);
        WideNode made = innerNode(maskOf(source.index), out_.palette[source.value]);
        made.kind = shared::kWideUniform;
        return {made, lodOf(source.index)};
    }

    const OctreeRegion& region_;
    const WidenSettings& settings_;
    WidePiece& out_;
};

}  // namespace

WideRoot widenRegion(const OctreeRegion& region, const WidenSettings& settings, WidePiece& out) {
    const WideRoot root = RegionWidener(region, settings, out).run();
    out.values.resize((out.values.size() + 3) / 4 * 4);
    return root;
}

}  // namespace pfvox::gpu::detail
