// Memory that the CPU writes and the device copies from, in segments: while the device copies one, the CPU
// fills the next.
#pragma once

#include <array>
#include <functional>
#include <span>
#include <vector>

#include "gpu/allocation.hpp"
#include "gpu/vulkan.hpp"

namespace pfvox::gpu::detail {

/// Throws what Vulkan throws. Numbers of submissions are values of the context's timeline semaphore.
class StagingRing {
  public:
    /// What the ring needs of its device.
    struct Services {
        std::function<Allocation(std::uint64_t sizeBytes)> allocate;
        std::function<void(const Allocation&)> freed;
        std::function<vk::raii::CommandBuffer()> createCommands;
        std::function<std::uint64_t(const vk::raii::CommandBuffer&)> submit;  ///< returns its number
        std::function<void(std::uint64_t submission)> wait;
    };
    explicit StagingRing(Services services) : services_(std::move(services)) {}

    /// Room whose content goes to `target` with the next recordCopies() or earlier. Valid until the next
    /// call.
    std::span<std::byte> stage(vk::Buffer target, std::uint64_t offsetBytes, std::uint64_t sizeBytes);

    bool hasPendingCopies() const { return !segments_[current_].copies.empty(); }
    /// Puts the copies that have not been submitted into these commands, and goes on with the next segment
    /// once `submission` is known.
    void recordCopies(const vk::raii::CommandBuffer& commands);
    void submitted(std::uint64_t submission);
    /// Forgets copies to a buffer that goes away, and waits for those under way.
    void forget(vk::Buffer target);

  private:
    struct Copy {
        vk::Buffer target;
        vk::BufferCopy region;
    };
    struct Segment {
        Allocation memory;
        vk::raii::CommandBuffer commands{nullptr};
        std::uint64_t usedBytes = 0;
        std::uint64_t submission = 0;  ///< the last one that reads it
        std::vector<Copy> copies;
    };
    static void record(const Segment& segment, const vk::raii::CommandBuffer& commands);
    void startCopying();
    void goOn();
    void ensureRoom(std::uint64_t sizeBytes);

    Services services_;
    std::array<Segment, 4> segments_;
    std::size_t current_ = 0;
};

}  // namespace pfvox::gpu::detail
