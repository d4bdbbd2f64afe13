// Everything that an opened device consists of. Shared by Device, Buffer and Program, so that it outlives
// them.
#pragma once

#include <functional>
#include <pfvox/gpu.hpp>
#include <pfvox/gpu_native.hpp>

#include "gpu/allocation.hpp"
#include "gpu/instance.hpp"
#include "gpu/staging_ring.hpp"
#include "gpu/vulkan.hpp"

namespace pfvox::gpu::detail {

class DeviceContext;

enum class MemoryKind : std::uint8_t { Device, Staging };

struct BufferState {
    std::shared_ptr<DeviceContext> device;
    Allocation allocation;
    std::uint64_t address = 0;

    BufferState(std::shared_ptr<DeviceContext> owner, Allocation made, std::uint64_t where)
        : device(std::move(owner)), allocation(std::move(made)), address(where) {}
    BufferState(const BufferState&) = delete;
    BufferState& operator=(const BufferState&) = delete;
    ~BufferState();
};

struct ProgramState {
    std::shared_ptr<DeviceContext> device;
    vk::raii::PipelineLayout layout{nullptr};
    vk::raii::Pipeline pipeline{nullptr};
    std::uint32_t pushConstantBytes = 0;
};

class DeviceContext {
  public:
    static Result<std::shared_ptr<DeviceContext>> open(const DeviceOptions& options);
    DeviceContext(Instance instance, FoundDevice found, const DeviceOptions& options);
    ~DeviceContext();
    DeviceContext(const DeviceContext&) = delete;
    DeviceContext& operator=(const DeviceContext&) = delete;

    const DeviceInfo& info() const { return found_.info; }
    const vk::raii::Device& device() const { return device_; }
    NativeDevice native() const;
    std::uint64_t maxBufferBytes() const { return maxBufferBytes_; }
    std::vector<std::string> validationMessages() const { return instance_.log->messages(); }
    MemoryUse memory() const { return memory_; }

    // These throw what Vulkan throws; callers are inside guarded().
    Allocation allocate(std::uint64_t sizeBytes, MemoryKind kind);
    void account(std::uint64_t addedBytes, std::uint64_t freedBytes);
    void nameObject(vk::ObjectType type, std::uint64_t handle, const std::string& name) const;
    /// Records commands, submits them and waits. Returns the milliseconds between the first and the last.
    double submit(const std::function<void(const vk::raii::CommandBuffer&)>& record);
    /// Calls `record` for each piece. Returns the milliseconds of each; zeros where the queue has no time
    /// stamps.
    std::vector<double> submitTimed(
        std::uint32_t pieces,
        const std::function<void(const vk::raii::CommandBuffer&, std::uint32_t)>& record);

    std::span<std::byte> stage(vk::Buffer target, std::uint64_t offsetBytes, std::uint64_t sizeBytes) {
        return staging_.stage(target, offsetBytes, sizeBytes);
    }
    void flush();
    void download(vk::Buffer source, std::uint64_t offsetBytes, std::span<std::byte> bytes);
    /// Before a buffer goes away.
    void release(const Allocation& allocation);

  private:
    void createDevice(const std::vector<std::string>& extensions);
    StagingRing::Services stagingServices();
    vk::raii::CommandBuffer createCommands() const;
    std::uint64_t submitCommands(const vk::raii::CommandBuffer& commands);
    void wait(std::uint64_t submission) const;
    std::uint32_t memoryType(std::uint32_t allowed, MemoryKind kind) const;
    double elapsedMs() const;
    double msBetween(std::uint64_t first, std::uint64_t last) const;

    Instance instance_;
    FoundDevice found_;
    vk::raii::Device device_{nullptr};
    vk::raii::Queue queue_{nullptr};
    vk::raii::CommandPool commandPool_{nullptr};
    vk::raii::CommandBuffer commands_{nullptr};
    vk::raii::Semaphore timeline_{nullptr};
    vk::raii::QueryPool timeStamps_{nullptr};
    vk::raii::QueryPool pieceStamps_{nullptr};
    std::uint32_t pieceStampCount_ = 0;
    std::uint64_t submissions_ = 0;
    std::uint64_t maxBufferBytes_ = 0;
    std::uint64_t mostMemoryBytes_ = ~std::uint64_t{0};
    double timeStampNs_ = 0.0;  ///< 0 = the queue has none
    std::uint32_t timeStampBits_ = 0;
    MemoryUse memory_;

    StagingRing staging_;
    Allocation readback_;
};

}  // namespace pfvox::gpu::detail
