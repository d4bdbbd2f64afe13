#include "octree/node_writer.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <bit>
#include <pfvox/assert.hpp>

namespace pfvox::octree {

namespace {

constexpr std::uint32_t kMaxFarEntries = 1u << 15;

}  // namespace

void NodeWriter::clear() {
    records_.clear();
    values_.clear();
}

void NodeWriter::push(const Slot& node, std::uint8_t valueMask) {
    const bool hasInner = node.validMask != node.leafMask;
    const auto position = static_cast<std::uint32_t>(records_.size());
    records_.push_back({.distance = hasInner ? position - node.firstChild : 0,
                        .leafMask = node.leafMask,
                        .validMask = node.validMask,
                        .valueMask = valueMask});
    for (unsigned rest = valueMask; rest != 0;) {
        const auto slot = static_cast<unsigned>(std::bit_width(rest)) - 1;
        rest &= ~(1u << slot);
        values_.push_back(node.values[slot]);
    }
}

Slot NodeWriter::combine(const std::array<Slot, 8>& children) {
    Slot parent;
    bool uniform = true;
    bool first = true;
    for (std::uint32_t k = 0; k < 8; ++k) {
        const Slot& child = children[k];
        if (child.kind == Slot::Kind::Empty) continue;
        const auto bit = static_cast<std::uint8_t>(1u << k);
        parent.validMask |= bit;
        if (child.kind == Slot::Kind::Leaf) parent.leafMask |= bit;
        if (child.uniform) {
            parent.valueMask |= bit;
            parent.values[k] = child.material;
        }
        if (first) parent.material = child.material;
        uniform = uniform && child.uniform && child.material == parent.material;
        first = false;
    }
    if (first) return {};
    parent.uniform = uniform;
    if (parent.leafMask == 0xff && uniform) return Slot::leaf(parent.material);

    for (std::uint32_t k = 8; k-- > 0;) {
        // A uniform child keeps no values: its parent, or an ancestor, holds the one value of its subtree.
        if (children[k].kind == Slot::Kind::Inner) {
            push(children[k], children[k].uniform ? std::uint8_t{0} : children[k].valueMask);
        }
    }
    parent.firstChild = static_cast<std::uint32_t>(records_.size()) - 1;
    parent.kind = Slot::Kind::Inner;
    return parent;
}

void NodeWriter::finish(const Slot& root) {
    PFVOX_ASSERT(root.kind != Slot::Kind::Empty);
    Slot node = root;
    if (root.kind == Slot::Kind::Leaf) {
        node = Slot{.kind = Slot::Kind::Inner, .validMask = 0xff, .leafMask = 0xff, .valueMask = 0xff};
        node.values.fill(root.material);
    }
    push(node, node.valueMask);  // no ancestor could hold the root's values
}

std::vector<std::uint32_t> NodeWriter::stripRoot(std::uint32_t maxLevels) {
    std::vector<std::uint32_t> slots;
    while (slots.size() < maxLevels) {
        const Record root = records_.back();
        if (!std::has_single_bit(root.validMask)) break;
        slots.push_back(static_cast<std::uint32_t>(std::countr_zero(root.validMask)));
        if (root.leafMask != 0) {
            // One leaf in one slot: the same cube, one level down, as eight leaves.
            records_.back() = {.distance = 0, .leafMask = 0xff, .validMask = 0xff, .valueMask = 0xff};
            const MaterialIndex material = values_.back();
            values_.insert(values_.end(), 7, material);
            break;
        }
        records_.pop_back();
        if (root.valueMask != 0) {
            // The only child was uniform: as root it must carry its own values, one for each of its slots.
            const MaterialIndex material = values_.back();
            values_.pop_back();
            Record& child = records_.back();
            child.valueMask = child.validMask;
            values_.insert(values_.end(), static_cast<std::size_t>(std::popcount(child.validMask)), material);
        }
    }
    return slots;
}

Result<void> NodeWriter::writeTree(NodeTree& tree) const {
    tree.nodes.resize(records_.size());
    tree.farTable.clear();
    std::uint32_t* out = tree.nodes.data();
    for (std::size_t i = records_.size(); i-- > 0;) {
        const Record& r = records_[i];
        std::uint32_t descriptor = r.leafMask | (static_cast<std::uint32_t>(r.validMask) << 8);
        if (r.distance <= node::kMaxNearPointer) {
            descriptor |= r.distance << node::kPointerShift;
        } else {
            descriptor |=
                node::kFarBit | (static_cast<std::uint32_t>(tree.farTable.size()) << node::kPointerShift);
            tree.farTable.push_back(r.distance);
        }
        *out++ = descriptor;
    }
    if (tree.farTable.size() > kMaxFarEntries) {
        return fail(ErrorCode::LimitExceeded, fmt::format("{} far pointers in one tree, more than {}",
                                                          tree.farTable.size(), kMaxFarEntries));
    }
    return {};
}

Result<void> NodeWriter::writeAttributes(std::size_t materialCount, OctreeRegion& region) const {
    region.lookup.resize(records_.size());
    std::uint32_t* out = region.lookup.data();
    std::uint32_t valuePointer = 0;
    for (std::size_t i = records_.size(); i-- > 0;) {
        const std::uint32_t mask = records_[i].valueMask;
        *out++ = mask | (valuePointer << 8);
        valuePointer += static_cast<std::uint32_t>(std::popcount(mask));
    }

    std::vector<std::uint16_t> paletteIndex(materialCount, 0);
    for (const MaterialIndex m : values_) {
        if (m >= materialCount) {
            return fail(
                ErrorCode::BadReference,
                fmt::format("a voxel has material {}, but there are only {} materials", m, materialCount));
        }
        paletteIndex[m] = 1;
    }
    region.palette.clear();
    for (std::size_t m = 0; m < materialCount; ++m) {
        if (paletteIndex[m] == 0) continue;
        paletteIndex[m] = static_cast<std::uint16_t>(region.palette.size());
        region.palette.push_back(static_cast<MaterialIndex>(m));
    }
    region.values.resize(values_.size() * region.valueBytes());
    std::uint8_t* bytes = region.values.data();
    if (region.valueBytes() == 1) {
        for (std::size_t i = values_.size(); i-- > 0;)
            *bytes++ = static_cast<std::uint8_t>(paletteIndex[values_[i]]);
    } else {
        for (std::size_t i = values_.size(); i-- > 0;) {
            *bytes++ = static_cast<std::uint8_t>(paletteIndex[values_[i]] & 0xff);
            *bytes++ = static_cast<std::uint8_t>(paletteIndex[values_[i]] >> 8);
        }
    }
    return {};
}

}  // namespace pfvox::octree
