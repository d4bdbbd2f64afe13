#include <algorithm>
#include <pfvox/assert.hpp>
#include <pfvox/gpu.hpp>
#include <pfvox/gpu_native.hpp>

#include "gpu/device_context.hpp"

namespace pfvox::gpu {

using detail::guarded;

// --- Handles ---

Buffer::Buffer(std::unique_ptr<detail::BufferState> state) : state_(std::move(state)) {}
Buffer::Buffer(Buffer&&) noexcept = default;
Buffer& Buffer::operator=(Buffer&&) noexcept = default;
Buffer::~Buffer() = default;
std::uint64_t Buffer::sizeBytes() const {
    return state_->allocation.sizeBytes;
}
std::uint64_t Buffer::address() const {
    return state_->address;
}

Program::Program(std::unique_ptr<detail::ProgramState> state) : state_(std::move(state)) {}
Program::Program(Program&&) noexcept = default;
Program& Program::operator=(Program&&) noexcept = default;
Program::~Program() = default;

Device::Device(std::shared_ptr<detail::DeviceContext> context) : context_(std::move(context)) {}
Device::Device(Device&&) noexcept = default;
Device& Device::operator=(Device&&) noexcept = default;
Device::~Device() = default;

// --- Devices ---

Result<std::vector<DeviceInfo>> listDevices() {
    PFVOX_TRY(const detail::Instance, instance, detail::createInstance({}));
    PFVOX_TRY(const std::vector<detail::FoundDevice>, found, detail::findDevices(instance, {}));
    std::vector<DeviceInfo> devices;
    for (const detail::FoundDevice& device : found) devices.push_back(device.info);
    return devices;
}

Result<Device> Device::open(const DeviceOptions& options) {
    PFVOX_TRY(std::shared_ptr<detail::DeviceContext>, context, detail::DeviceContext::open(options));
    return Device(std::move(context));
}

const DeviceInfo& Device::info() const {
    return context_->info();
}
MemoryUse Device::memory() const {
    return context_->memory();
}
std::uint64_t Device::maxBufferBytes() const {
    return context_->maxBufferBytes();
}
std::vector<std::string> Device::validationMessages() const {
    return context_->validationMessages();
}

NativeDevice nativeOf(const Device& device) {
    return device.context_->native();
}
VkBuffer_T* nativeOf(const Buffer& buffer) {
    return static_cast<VkBuffer>(*buffer.state_->allocation.buffer);
}

// --- Buffers ---

Result<Buffer> Device::createBuffer(std::uint64_t sizeBytes, std::string_view name) {
    const std::string label(name);
    return guarded("buffer '" + label + "' of " + std::to_string(sizeBytes) + " bytes", [&] {
        detail::Allocation made = context_->allocate(sizeBytes, detail::MemoryKind::Device);
        const auto handle = reinterpret_cast<std::uint64_t>(static_cast<VkBuffer>(*made.buffer));
        context_->nameObject(vk::ObjectType::eBuffer, handle, label);
        const std::uint64_t address = context_->device().getBufferAddress({.buffer = *made.buffer});
        return Buffer(std::make_unique<detail::BufferState>(context_, std::move(made), address));
    });
}

Result<std::span<std::byte>> Device::stage(const Buffer& target, std::uint64_t offsetBytes,
                                           std::uint64_t sizeBytes) {
    PFVOX_ASSERT(offsetBytes % 4 == 0 && sizeBytes % 4 == 0 && sizeBytes > 0);
    PFVOX_ASSERT(offsetBytes <= target.sizeBytes() && sizeBytes <= target.sizeBytes() - offsetBytes);
    return guarded(
        "upload", [&] { return context_->stage(*target.state_->allocation.buffer, offsetBytes, sizeBytes); });
}

Result<void> Device::upload(const Buffer& target, std::uint64_t offsetBytes,
                            std::span<const std::byte> bytes) {
    constexpr std::size_t kPieceBytes = 16u << 20;
    for (std::size_t done = 0; done < bytes.size();) {
        const std::size_t piece = std::min(kPieceBytes, bytes.size() - done);
        PFVOX_TRY(const std::span<std::byte>, room, stage(target, offsetBytes + done, piece));
        std::ranges::copy(bytes.subspan(done, piece), room.begin());
        done += piece;
    }
    return {};
}

Result<void> Device::flush() {
    return guarded("upload", [&] { context_->flush(); });
}

Result<void> Device::download(const Buffer& source, std::uint64_t offsetBytes, std::span<std::byte> bytes) {
    PFVOX_ASSERT(offsetBytes % 4 == 0 && bytes.size() % 4 == 0);
    PFVOX_ASSERT(offsetBytes <= source.sizeBytes() && bytes.size() <= source.sizeBytes() - offsetBytes);
    return guarded("download",
                   [&] { context_->download(*source.state_->allocation.buffer, offsetBytes, bytes); });
}

// --- Programs ---

Result<Program> Device::createProgram(std::span<const std::uint32_t> spirv, std::uint32_t pushConstantBytes,
                                      std::string_view name, std::span<const std::uint32_t> constants) {
    const std::string label(name);
    return guarded("program '" + label + "'", [&] {
        auto state = std::make_unique<detail::ProgramState>();
        state->device = context_;
        state->pushConstantBytes = pushConstantBytes;
        const vk::raii::Device& device = context_->device();
        const vk::PushConstantRange range{.stageFlags = vk::ShaderStageFlagBits::eCompute,
                                          .size = pushConstantBytes};
        state->layout =
            vk::raii::PipelineLayout(device, vk::PipelineLayoutCreateInfo{}.setPushConstantRanges(range));
        const vk::raii::ShaderModule module(device, vk::ShaderModuleCreateInfo{}.setCode(spirv));
        std::vector<vk::SpecializationMapEntry> entries;
        for (std::uint32_t i = 0; i < constants.size(); ++i)
            entries.push_back({.constantID = i, .offset = 4 * i, .size = 4});
        const auto specialization =
            vk::SpecializationInfo{}.setMapEntries(entries).setData<const std::uint32_t>(constants);
        state->pipeline = vk::raii::Pipeline(
            device, nullptr,
            vk::ComputePipelineCreateInfo{.stage = {.stage = vk::ShaderStageFlagBits::eCompute,
                                                    .module = *module,
                                                    .pName = "main",
                                                    .pSpecializationInfo = &specialization},
                                          .layout = *state->layout});
        const auto handle = reinterpret_cast<std::uint64_t>(static_cast<VkPipeline>(*state->pipeline));
        context_->nameObject(vk::ObjectType::ePipeline, handle, label);
        return Program(std::move(state));
    });
}

namespace {

void record(const vk::raii::CommandBuffer& commands, const detail::ProgramState& program,
            const Dispatch& dispatch) {
    PFVOX_ASSERT(dispatch.pushConstants.size() == program.pushConstantBytes);
    commands.bindPipeline(vk::PipelineBindPoint::eCompute, *program.pipeline);
    commands.pushConstants<std::byte>(
        *program.layout, vk::ShaderStageFlagBits::eCompute, 0,
        {static_cast<std::uint32_t>(dispatch.pushConstants.size()), dispatch.pushConstants.data()});
    if (dispatch.groupsFrom != nullptr) {
        PFVOX_ASSERT(dispatch.groupsAtBytes % 4 == 0);
        PFVOX_ASSERT(dispatch.groupsAtBytes + 12 <= dispatch.groupsFrom->sizeBytes());
        commands.dispatchIndirect(nativeOf(*dispatch.groupsFrom), dispatch.groupsAtBytes);
    } else {
        commands.dispatch(dispatch.groups.x, dispatch.groups.y, dispatch.groups.z);
    }
    const vk::MemoryBarrier written{
        .srcAccessMask = vk::AccessFlagBits::eShaderWrite,
        .dstAccessMask = vk::AccessFlagBits::eShaderRead | vk::AccessFlagBits::eShaderWrite |
                         vk::AccessFlagBits::eIndirectCommandRead | vk::AccessFlagBits::eTransferRead |
                         vk::AccessFlagBits::eTransferWrite};
    commands.pipelineBarrier(vk::PipelineStageFlagBits::eComputeShader,
                             vk::PipelineStageFlagBits::eComputeShader |
                                 vk::PipelineStageFlagBits::eDrawIndirect |
                                 vk::PipelineStageFlagBits::eTransfer,
                             {}, written, nullptr, nullptr);
}

}  // namespace

Result<double> Device::run(std::span<const Dispatch> dispatches) {
    return guarded("run", [&] {
        return context_->submit([&](const vk::raii::CommandBuffer& commands) {
            for (const Dispatch& dispatch : dispatches) record(commands, *dispatch.program->state_, dispatch);
        });
    });
}

Result<std::vector<double>> Device::runTimed(std::span<const Dispatch> dispatches) {
    return guarded("run", [&] {
        return context_->submitTimed(static_cast<std::uint32_t>(dispatches.size()),
                                     [&](const vk::raii::CommandBuffer& commands, std::uint32_t piece) {
                                         record(commands, *dispatches[piece].program->state_,
                                                dispatches[piece]);
                                     });
    });
}

}  // namespace pfvox::gpu
