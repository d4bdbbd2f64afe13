#include "octree/node_writer.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <bit>
#include <pfvox/assert.hpp>
#include <span>

#include "octree/lanes.hpp"

namespace pfvox::octree {

namespace {

constexpr std::uint32_t kMaxFarEntries = 1u << 15;

unsigned highestBit(unsigned mask) {
    return static_cast<unsigned>(std::bit_width(mask)) - 1;
}

/// Writes the values of the slots in `mask`, from the highest slot to the lowest; returns the end. May write
/// up to one element behind the end. Without a branch, as masks of noisy models cannot be predicted.
MaterialIndex* writeValues(unsigned mask, const MaterialIndex* bySlot, MaterialIndex* out) {
    for (unsigned slot = 8; slot-- > 0;) {
        *out = bySlot[slot];
        out += (mask >> slot) & 1u;
    }
    return out;
}

}  // namespace

void NodeWriter::clear() {
    records_.clear();
    values_.clear();
}

void NodeWriter::push(const Slot& node, std::uint8_t valueMask) {
    const bool hasInner = node.validMask != node.leafMask;
    const auto position = static_cast<std::uint32_t>(records_.size());
    Record* record = records_.room(1);
    *record = {.distance = hasInner ? position - node.firstChild : 0,
               .leafMask = node.leafMask,
               .validMask = node.validMask,
               .valueMask = valueMask,
               .valueCount = kBitCount[valueMask]};
    records_.advance(record + 1);
    values_.advance(writeValues(valueMask, node.values.data(), values_.room(8 + 1)));
}

Slot NodeWriter::combineVoxels(std::uint64_t occupancy, const MaterialIndex* materials) {
    if (occupancy == 0) return {};
    Slot parent{.kind = Slot::Kind::Inner, .validMask = static_cast<std::uint8_t>(nonZeroBytes(occupancy))};
    Record* const firstRecord = records_.room(8);
    Record* record = firstRecord;
    MaterialIndex* value = values_.room(64 + 1);
    unsigned leafMask = 0;
    unsigned uniformMask = 0;
    for (unsigned rest = parent.validMask; rest != 0;) {
        const unsigned k = highestBit(rest);
        rest ^= 1u << k;
        const auto mask = static_cast<std::uint8_t>(occupancy >> (8 * k));
        const MaterialIndex* octet = materials + std::size_t{8} * k;
        const MaterialIndex reference = octet[std::countr_zero(mask)];
        const bool uniform = (mask & ~equalLanes(octet, reference)) == 0;
        parent.values[k] = reference;
        uniformMask |= static_cast<unsigned>(uniform) << k;
        if (uniform && mask == 0xff) {
            leafMask |= 1u << k;
            continue;
        }
        // A uniform node keeps no values: its parent, or an ancestor, holds the one value of its subtree.
        const std::uint8_t valueMask = uniform ? std::uint8_t{0} : mask;
        *record++ = {.distance = 0,
                     .leafMask = mask,
                     .validMask = mask,
                     .valueMask = valueMask,
                     .valueCount = kBitCount[valueMask]};
        if (!uniform) value = writeValues(mask, octet, value);
    }
    parent.leafMask = static_cast<std::uint8_t>(leafMask);
    parent.valueMask = static_cast<std::uint8_t>(uniformMask);
    parent.material = parent.values[static_cast<std::size_t>(std::countr_zero(parent.validMask))];
    parent.uniform = uniformMask == parent.validMask &&
                     (uniformMask & ~equalLanes(parent.values.data(), parent.material)) == 0;
    if (leafMask == 0xff && parent.uniform) return Slot::leaf(parent.material);
    records_.advance(record);
    values_.advance(value);
    parent.firstChild = static_cast<std::uint32_t>(records_.size()) - 1;
    return parent;
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
            records_.back() = {
                .distance = 0, .leafMask = 0xff, .validMask = 0xff, .valueMask = 0xff, .valueCount = 8};
            const MaterialIndex material = values_.back();
            values_.append(7, material);
            break;
        }
        records_.popBack();
        if (root.valueMask != 0) {
            // The only child was uniform: as root it must carry its own values, one for each of its slots.
            const MaterialIndex material = values_.back();
            values_.popBack();
            Record& child = records_.back();
            child.valueMask = child.validMask;
            child.valueCount = kBitCount[child.valueMask];
            values_.append(child.valueCount, material);
        }
    }
    return slots;
}

Result<void> NodeWriter::writeTree(NodeTree& tree) const {
    tree.nodes.resize(records_.size());
    tree.farTable.clear();
    std::uint32_t* out = tree.nodes.data();
    for (std::size_t i = records_.size(); i-- > 0;) {
        const Record& r = records_.data()[i];
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
        const Record& r = records_.data()[i];
        *out++ = r.valueMask | (valuePointer << 8);
        valuePointer += r.valueCount;
    }

    std::vector<std::uint16_t> paletteIndex(materialCount, 0);
    for (const MaterialIndex m : std::span(values_.data(), values_.size())) {
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
    const MaterialIndex* const values = values_.data();
    if (region.valueBytes() == 1) {
        for (std::size_t i = values_.size(); i-- > 0;)
            *bytes++ = static_cast<std::uint8_t>(paletteIndex[values[i]]);
    } else {
        for (std::size_t i = values_.size(); i-- > 0;) {
            *bytes++ = static_cast<std::uint8_t>(paletteIndex[values[i]] & 0xff);
            *bytes++ = static_cast<std::uint8_t>(paletteIndex[values[i]] >> 8);
        }
    }
    return {};
}

}  // namespace pfvox::octree
