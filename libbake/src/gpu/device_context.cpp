#include "gpu/device_context.hpp"

#include <algorithm>
#include <array>
#include <limits>

namespace pfvox::gpu::detail {

namespace {

constexpr std::uint64_t kAddressAlignment = 256;
constexpr std::uint64_t kMaxU64 = std::numeric_limits<std::uint64_t>::max();

std::uint64_t largestBuffer(const vk::raii::PhysicalDevice& device) {
    const auto chain =
        device.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceVulkan11Properties>();
    return chain.get<vk::PhysicalDeviceVulkan11Properties>().maxMemoryAllocationSize / kAddressAlignment *
           kAddressAlignment;
}

/// Everything before is visible to everything after: copies and dispatches are few and large, finer barriers
/// gain nothing.
void fullBarrier(const vk::raii::CommandBuffer& commands) {
    const vk::MemoryBarrier all{
        .srcAccessMask = vk::AccessFlagBits::eMemoryWrite,
        .dstAccessMask = vk::AccessFlagBits::eMemoryRead | vk::AccessFlagBits::eMemoryWrite};
    commands.pipelineBarrier(vk::PipelineStageFlagBits::eAllCommands, vk::PipelineStageFlagBits::eAllCommands,
                             {}, all, nullptr, nullptr);
}

}  // namespace

BufferState::~BufferState() {
    device->release(allocation);
}

Result<std::shared_ptr<DeviceContext>> DeviceContext::open(const DeviceOptions& options) {
    PFVOX_TRY(Instance, instance, createInstance(options));
    PFVOX_TRY(std::vector<FoundDevice>, devices, findDevices(instance, options));
    PFVOX_TRY(const std::size_t, chosen, selectDevice(devices, options.selector));
    return guarded("cannot open device '" + devices[chosen].info.name + "'", [&] {
        return std::make_shared<DeviceContext>(std::move(instance), std::move(devices[chosen]), options);
    });
}

DeviceContext::DeviceContext(Instance instance, FoundDevice found, const DeviceOptions& options)
    : instance_(std::move(instance)), found_(std::move(found)), staging_(stagingServices()) {
    if (options.memoryBytes != 0) {
        mostMemoryBytes_ = options.memoryBytes;
        found_.info.localMemoryBytes = std::min(found_.info.localMemoryBytes, options.memoryBytes);
    }
    createDevice(options.deviceExtensions);
    queue_ = device_.getQueue(found_.queueFamily, 0);
    commandPool_ =
        vk::raii::CommandPool(device_, {.flags = vk::CommandPoolCreateFlagBits::eResetCommandBuffer,
                                        .queueFamilyIndex = found_.queueFamily});
    commands_ = createCommands();
    const vk::SemaphoreTypeCreateInfo timeline{.semaphoreType = vk::SemaphoreType::eTimeline,
                                               .initialValue = 0};
    timeline_ = vk::raii::Semaphore(device_, vk::SemaphoreCreateInfo{.pNext = &timeline});
    timeStamps_ = vk::raii::QueryPool(device_, {.queryType = vk::QueryType::eTimestamp, .queryCount = 2});
    timeStampBits_ = found_.physical.getQueueFamilyProperties()[found_.queueFamily].timestampValidBits;
    if (timeStampBits_ != 0) {
        timeStampNs_ = static_cast<double>(found_.physical.getProperties().limits.timestampPeriod);
    }
    maxBufferBytes_ = largestBuffer(found_.physical);
}

DeviceContext::~DeviceContext() {
    try {
        wait(submissions_);       // copies may be under way
    } catch (const vk::Error&) {  // of a lost device: nothing is
    }
}

void DeviceContext::createDevice(const std::vector<std::string>& extensions) {
    const float priority = 1.0f;
    const vk::DeviceQueueCreateInfo queue{
        .queueFamilyIndex = found_.queueFamily, .queueCount = 1, .pQueuePriorities = &priority};
    const vk::PhysicalDeviceVulkan12Features features{.timelineSemaphore = true, .bufferDeviceAddress = true};
    const std::vector<const char*> names = pointersTo(extensions);
    device_ = vk::raii::Device(
        found_.physical,
        vk::DeviceCreateInfo{.pNext = &features, .queueCreateInfoCount = 1, .pQueueCreateInfos = &queue}
            .setPEnabledExtensionNames(names));
}

NativeDevice DeviceContext::native() const {
    return {.instance = static_cast<VkInstance>(*instance_.instance),
            .physicalDevice = static_cast<VkPhysicalDevice>(*found_.physical),
            .device = static_cast<VkDevice>(*device_),
            .queue = static_cast<VkQueue>(*queue_),
            .queueFamily = found_.queueFamily};
}

std::uint32_t DeviceContext::memoryType(std::uint32_t allowed, MemoryKind kind) const {
    using enum vk::MemoryPropertyFlagBits;
    const vk::MemoryPropertyFlags shared = eHostVisible | eHostCoherent;
    // Best first. Downloads read staging memory, which is slow where it is not cached.
    const std::array<vk::MemoryPropertyFlags, 2> wanted =
        kind == MemoryKind::Device
            ? std::array<vk::MemoryPropertyFlags, 2>{eDeviceLocal, vk::MemoryPropertyFlags{}}
            : std::array<vk::MemoryPropertyFlags, 2>{shared | eHostCached, shared};
    const vk::PhysicalDeviceMemoryProperties memory = found_.physical.getMemoryProperties();
    for (const vk::MemoryPropertyFlags flags : wanted) {
        for (std::uint32_t i = 0; i < memory.memoryTypeCount; ++i) {
            if ((allowed >> i & 1u) != 0 && (memory.memoryTypes[i].propertyFlags & flags) == flags) return i;
        }
    }
    throw vk::OutOfDeviceMemoryError("no fitting memory type");
}

Allocation DeviceContext::allocate(std::uint64_t sizeBytes, MemoryKind kind) {
    Allocation made;
    made.sizeBytes = (std::max<std::uint64_t>(sizeBytes, 1) + kAddressAlignment - 1) / kAddressAlignment *
                     kAddressAlignment;
    if (made.sizeBytes > maxBufferBytes_)
        throw vk::OutOfDeviceMemoryError("larger than one allocation may be");
    if (made.sizeBytes > mostMemoryBytes_ - std::min(memory_.currentBytes, mostMemoryBytes_))
        throw vk::OutOfDeviceMemoryError("more than may be taken of the device's memory");
    vk::BufferUsageFlags usage =
        vk::BufferUsageFlagBits::eTransferSrc | vk::BufferUsageFlagBits::eTransferDst;
    if (kind == MemoryKind::Device) {
        usage |= vk::BufferUsageFlagBits::eStorageBuffer | vk::BufferUsageFlagBits::eShaderDeviceAddress |
                 vk::BufferUsageFlagBits::eIndirectBuffer;
    }
    made.buffer = vk::raii::Buffer(device_, {.size = made.sizeBytes, .usage = usage});
    const vk::MemoryRequirements needs = made.buffer.getMemoryRequirements();
    const vk::MemoryAllocateFlagsInfo flags{.flags = vk::MemoryAllocateFlagBits::eDeviceAddress};
    vk::MemoryAllocateInfo info{.allocationSize = needs.size,
                                .memoryTypeIndex = memoryType(needs.memoryTypeBits, kind)};
    if (kind == MemoryKind::Device) info.pNext = &flags;
    made.memory = vk::raii::DeviceMemory(device_, info);
    made.buffer.bindMemory(*made.memory, 0);
    if (kind == MemoryKind::Staging)
        made.mapped = static_cast<std::byte*>(made.memory.mapMemory(0, made.sizeBytes));
    account(made.sizeBytes, 0);
    return made;
}

void DeviceContext::account(std::uint64_t addedBytes, std::uint64_t freedBytes) {
    memory_.currentBytes += addedBytes;
    memory_.currentBytes -= freedBytes;
    memory_.peakBytes = std::max(memory_.peakBytes, memory_.currentBytes);
}

void DeviceContext::nameObject(vk::ObjectType type, std::uint64_t handle, const std::string& name) const {
    if (!*instance_.messenger) return;  // the extension is on only with validation
    device_.setDebugUtilsObjectNameEXT(
        {.objectType = type, .objectHandle = handle, .pObjectName = name.c_str()});
}

vk::raii::CommandBuffer DeviceContext::createCommands() const {
    return std::move(vk::raii::CommandBuffers(device_, {.commandPool = *commandPool_,
                                                        .level = vk::CommandBufferLevel::ePrimary,
                                                        .commandBufferCount = 1})[0]);
}

StagingRing::Services DeviceContext::stagingServices() {
    return {.allocate = [this](std::uint64_t sizeBytes) { return allocate(sizeBytes, MemoryKind::Staging); },
            .freed = [this](const Allocation& allocation) { account(0, allocation.sizeBytes); },
            .createCommands = [this] { return createCommands(); },
            .submit = [this](const vk::raii::CommandBuffer& commands) { return submitCommands(commands); },
            .wait = [this](std::uint64_t submission) { wait(submission); }};
}

std::uint64_t DeviceContext::submitCommands(const vk::raii::CommandBuffer& commands) {
    const std::uint64_t done = ++submissions_;
    const vk::TimelineSemaphoreSubmitInfo timeline{.signalSemaphoreValueCount = 1,
                                                   .pSignalSemaphoreValues = &done};
    queue_.submit(vk::SubmitInfo{.pNext = &timeline,
                                 .commandBufferCount = 1,
                                 .pCommandBuffers = &*commands,
                                 .signalSemaphoreCount = 1,
                                 .pSignalSemaphores = &*timeline_});
    return done;
}

void DeviceContext::wait(std::uint64_t submission) const {
    if (submission == 0) return;
    const vk::SemaphoreWaitInfo wait{.semaphoreCount = 1, .pSemaphores = &*timeline_, .pValues = &submission};
    if (device_.waitSemaphores(wait, kMaxU64) != vk::Result::eSuccess) {
        throw vk::DeviceLostError("waiting for the device");
    }
}

void DeviceContext::release(const Allocation& allocation) {
    account(0, allocation.sizeBytes);
    try {
        staging_.forget(*allocation.buffer);
    } catch (const vk::Error&) {  // of a lost device: nothing is under way any more
    }
}

double DeviceContext::submit(const std::function<void(const vk::raii::CommandBuffer&)>& record) {
    commands_.reset();
    commands_.begin({.flags = vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
    staging_.recordCopies(commands_);
    fullBarrier(commands_);
    if (timeStampNs_ > 0.0) {
        commands_.resetQueryPool(*timeStamps_, 0, 2);
        commands_.writeTimestamp(vk::PipelineStageFlagBits::eBottomOfPipe, *timeStamps_, 0);
    }
    record(commands_);
    if (timeStampNs_ > 0.0)
        commands_.writeTimestamp(vk::PipelineStageFlagBits::eBottomOfPipe, *timeStamps_, 1);
    commands_.end();

    const std::uint64_t done = submitCommands(commands_);
    wait(done);
    staging_.submitted(done);
    return elapsedMs();
}

double DeviceContext::elapsedMs() const {
    if (timeStampNs_ <= 0.0) return 0.0;
    const auto [result, ticks] = timeStamps_.getResults<std::uint64_t>(
        0, 2, 2 * sizeof(std::uint64_t), sizeof(std::uint64_t), vk::QueryResultFlagBits::e64);
    if (result != vk::Result::eSuccess) return 0.0;
    return msBetween(ticks[0], ticks[1]);
}

double DeviceContext::msBetween(std::uint64_t first, std::uint64_t last) const {
    const std::uint64_t mask = timeStampBits_ >= 64 ? kMaxU64 : (std::uint64_t{1} << timeStampBits_) - 1;
    return static_cast<double>((last - first) & mask) * timeStampNs_ * 1e-6;
}

std::vector<double> DeviceContext::submitTimed(
    std::uint32_t pieces, const std::function<void(const vk::raii::CommandBuffer&, std::uint32_t)>& record) {
    const bool timed = timeStampNs_ > 0.0;
    if (timed && pieceStampCount_ <= pieces) {
        pieceStampCount_ = pieces + 1;
        pieceStamps_ = vk::raii::QueryPool(
            device_, {.queryType = vk::QueryType::eTimestamp, .queryCount = pieceStampCount_});
    }
    submit([&](const vk::raii::CommandBuffer& commands) {
        const auto stamp = [&](std::uint32_t query) {
            if (timed)
                commands.writeTimestamp(vk::PipelineStageFlagBits::eBottomOfPipe, *pieceStamps_, query);
        };
        if (timed) commands.resetQueryPool(*pieceStamps_, 0, pieces + 1);
        stamp(0);
        for (std::uint32_t piece = 0; piece < pieces; ++piece) {
            record(commands, piece);
            stamp(piece + 1);
        }
    });
    std::vector<double> times(pieces, 0.0);
    if (!timed) return times;
    const std::size_t bytes = (pieces + 1) * sizeof(std::uint64_t);
    const auto [result, ticks] = pieceStamps_.getResults<std::uint64_t>(
        0, pieces + 1, bytes, sizeof(std::uint64_t), vk::QueryResultFlagBits::e64);
    if (result != vk::Result::eSuccess) return times;
    for (std::uint32_t piece = 0; piece < pieces; ++piece)
        times[piece] = msBetween(ticks[piece], ticks[piece + 1]);
    return times;
}

void DeviceContext::flush() {
    if (staging_.hasPendingCopies()) submit([](const vk::raii::CommandBuffer&) {});
}

void DeviceContext::download(vk::Buffer source, std::uint64_t offsetBytes, std::span<std::byte> bytes) {
    constexpr std::uint64_t kPieceBytes = 32u << 20;
    const std::uint64_t largest = std::min<std::uint64_t>(kPieceBytes, bytes.size());
    if (readback_.sizeBytes < largest) {
        account(0, readback_.sizeBytes);
        readback_ = {};
        readback_ = allocate(largest, MemoryKind::Staging);
    }
    for (std::uint64_t done = 0; done < bytes.size();) {
        const std::uint64_t piece = std::min<std::uint64_t>(kPieceBytes, bytes.size() - done);
        submit([&](const vk::raii::CommandBuffer& commands) {
            commands.copyBuffer(
                source, *readback_.buffer,
                vk::BufferCopy{.srcOffset = offsetBytes + done, .dstOffset = 0, .size = piece});
            const vk::MemoryBarrier toHost{.srcAccessMask = vk::AccessFlagBits::eTransferWrite,
                                           .dstAccessMask = vk::AccessFlagBits::eHostRead};
            commands.pipelineBarrier(vk::PipelineStageFlagBits::eTransfer, vk::PipelineStageFlagBits::eHost,
                                     {}, toHost, nullptr, nullptr);
        });
        std::copy_n(readback_.mapped, piece, bytes.data() + done);
        done += piece;
    }
}

}  // namespace pfvox::gpu::detail
