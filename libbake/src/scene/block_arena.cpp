#include "scene/block_arena.hpp"

#include <algorithm>
#include <string>

namespace pfvox::gpu::detail {

namespace {
constexpr std::uint64_t kUsualBufferBytes = 512u << 20;
}

BlockArena::BlockArena(std::uint64_t maxBufferBytes) : maxBufferBytes_(maxBufferBytes) {}

Result<BlockPlace> BlockArena::add(std::uint64_t sizeBytes) {
    if (sizeBytes > maxBufferBytes_) {
        return fail(ErrorCode::GpuOutOfMemory, "an octree block of " + std::to_string(sizeBytes) +
                                                   " bytes is larger than a buffer of this device can be");
    }
    const std::uint64_t limit = std::min(kUsualBufferBytes, maxBufferBytes_);
    if (sizes_.empty() || sizes_.back() + sizeBytes > limit) sizes_.push_back(0);
    const BlockPlace place{.buffer = sizes_.size() - 1, .offsetBytes = sizes_.back()};
    sizes_.back() += sizeBytes;
    return place;
}

Result<void> BlockArena::createBuffers(Device& device) {
    for (std::size_t i = 0; i < sizes_.size(); ++i) {
        PFVOX_TRY(Buffer, made, device.createBuffer(sizes_[i], "tree blocks " + std::to_string(i)));
        buffers_.push_back(std::move(made));
    }
    return {};
}

}  // namespace pfvox::gpu::detail
