// One region or top tree as a block of device memory: the words behind a shared::TreeBlockHeader.
#pragma once

#include <cstddef>
#include <pfvox/octree.hpp>
#include <span>
#include <vector>

#include "shared/scene.glsl.h"

namespace pfvox::gpu::detail {

/// Where a block's parts lie and how large it is. Blocks are multiples of kBlockAlignment.
struct BlockLayout {
    shared::TreeBlockHeader header{};
    std::uint64_t sizeBytes = 0;
    std::uint64_t valueBytes = 0;
};

inline constexpr std::uint64_t kBlockAlignment = 64;

BlockLayout layoutOfRegion(const OctreeRegion& region);
BlockLayout layoutOfTopTree(const OctreeModel& model);

/// Fills a block of layout.sizeBytes. `firstMaterial` is added to the palette's entries: a scene joins the
/// materials of its assets. `room` is written once and in order, never read: it may be write-combined memory.
void writeRegion(const OctreeRegion& region, const BlockLayout& layout, std::uint32_t firstMaterial,
                 std::span<std::byte> room);

/// `regionAddresses`: device addresses of the model's region blocks, in the model's order.
void writeTopTree(const OctreeModel& model, const BlockLayout& layout,
                  std::span<const std::uint64_t> regionAddresses, std::span<std::byte> room);

}  // namespace pfvox::gpu::detail
