// Places many tree blocks in few buffers: a driver allows some thousand allocations, a scene may have more
// regions.
#pragma once

#include <pfvox/gpu.hpp>
#include <vector>

namespace pfvox::gpu::detail {

struct BlockPlace {
    std::size_t buffer = 0;
    std::uint64_t offsetBytes = 0;
};

/// Blocks are added first, then all buffers are made at once, as large as needed.
class BlockArena {
  public:
    explicit BlockArena(std::uint64_t maxBufferBytes);

    /// Errors: GpuOutOfMemory when one block is larger than a buffer can be.
    Result<BlockPlace> add(std::uint64_t sizeBytes);
    Result<void> createBuffers(Device& device);

    const Buffer& buffer(BlockPlace place) const { return buffers_[place.buffer]; }
    std::uint64_t address(BlockPlace place) const { return buffer(place).address() + place.offsetBytes; }
    std::vector<Buffer> takeBuffers() { return std::move(buffers_); }

  private:
    std::uint64_t maxBufferBytes_;
    std::vector<std::uint64_t> sizes_;
    std::vector<Buffer> buffers_;
};

}  // namespace pfvox::gpu::detail
