#include "scene/tree_block.hpp"

#include <bit>
#include <cstring>
#include <pfvox/assert.hpp>

namespace pfvox::gpu::detail {

namespace {

std::uint32_t count32(std::size_t count) {
    PFVOX_ASSERT(count <= 0xffffffffu);
    return static_cast<std::uint32_t>(count);
}

void finish(BlockLayout& layout, std::size_t words) {
    const std::uint64_t bytes = sizeof(shared::TreeBlockHeader) + 4 * static_cast<std::uint64_t>(words);
    layout.sizeBytes = (bytes + kBlockAlignment - 1) / kBlockAlignment * kBlockAlignment;
}

/// Writes the parts of a block one after the other.
class BlockWriter {
  public:
    explicit BlockWriter(std::span<std::byte> room) : room_(room) {}

    template <class T>
    void put(std::span<const T> items) {
        PFVOX_ASSERT(at_ + items.size_bytes() <= room_.size());
        if (!items.empty()) std::memcpy(room_.data() + at_, items.data(), items.size_bytes());
        at_ += items.size_bytes();
    }
    void put(const auto& item) { put(std::span(&item, 1)); }

    void padTo(std::size_t offset) {
        PFVOX_ASSERT(at_ <= offset && offset <= room_.size());
        std::memset(room_.data() + at_, 0, offset - at_);
        at_ = offset;
    }

  private:
    std::span<std::byte> room_;
    std::size_t at_ = 0;
};

std::size_t offsetOf(std::uint32_t word) {
    return sizeof(shared::TreeBlockHeader) + 4 * std::size_t{word};
}

}  // namespace

BlockLayout layoutOfRegion(const OctreeRegion& region) {
    BlockLayout layout;
    layout.valueBytes = region.values.size();
    std::size_t words = region.tree.nodes.size();
    layout.header.lookupOffset = count32(words);
    words += region.lookup.size();
    layout.header.valuesOffset = count32(words);
    words += (layout.valueBytes + 3) / 4;
    layout.header.paletteOffset = count32(words);
    words += region.palette.size();
    layout.header.farOffset = count32(words);
    words += region.tree.farTable.size();
    layout.header.valueBits = 8 * count32(region.valueBytes());
    finish(layout, words);
    return layout;
}

BlockLayout layoutOfTopTree(const OctreeModel& model) {
    BlockLayout layout;
    std::size_t words = model.topTree.nodes.size();
    layout.header.lookupOffset = count32(words);
    words += model.topTree.nodes.size();
    layout.header.valuesOffset = count32(words);
    words += 2 * model.regions.size();
    layout.header.paletteOffset = count32(words);
    layout.header.farOffset = count32(words);
    words += model.topTree.farTable.size();
    finish(layout, words);
    return layout;
}

void writeRegion(const OctreeRegion& region, const BlockLayout& layout, std::uint32_t firstMaterial,
                 std::span<std::byte> room) {
    BlockWriter writer(room);
    writer.put(layout.header);
    writer.put(std::span(region.tree.nodes));
    writer.put(std::span(region.lookup));
    writer.put(std::span(region.values));
    writer.padTo(offsetOf(layout.header.paletteOffset));
    for (const MaterialIndex material : region.palette) writer.put(firstMaterial + std::uint32_t{material});
    writer.put(std::span(region.tree.farTable));
    writer.padTo(room.size());
}

void writeTopTree(const OctreeModel& model, const BlockLayout& layout,
                  std::span<const std::uint64_t> regionAddresses, std::span<std::byte> room) {
    BlockWriter writer(room);
    writer.put(layout.header);
    writer.put(std::span(model.topTree.nodes));
    std::uint32_t regionsBefore = 0;
    for (const std::uint32_t descriptor : model.topTree.nodes) {
        writer.put(regionsBefore);
        regionsBefore += static_cast<std::uint32_t>(std::popcount(node::leafMask(descriptor)));
    }
    PFVOX_ASSERT(regionsBefore == regionAddresses.size());
    writer.put(regionAddresses);
    writer.put(std::span(model.topTree.farTable));
    writer.padTo(room.size());
}

}  // namespace pfvox::gpu::detail
