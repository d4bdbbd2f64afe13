#include "window/presenter.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <stdexcept>

namespace pfvox::viewer {

namespace {

constexpr std::uint64_t kForever = std::numeric_limits<std::uint64_t>::max();

/// What Vulkan throws, as an Error.
template <class F>
Result<void> guarded(F&& f) {
    try {
        f();
        return {};
    } catch (const vk::DeviceLostError& error) {
        return fail(ErrorCode::GpuLost, std::string("window: ") + error.what());
    } catch (const vk::OutOfDeviceMemoryError& error) {
        return fail(ErrorCode::GpuOutOfMemory, std::string("window: ") + error.what());
    } catch (const std::exception& error) {
        return fail(ErrorCode::GpuUnavailable, std::string("window: ") + error.what());
    }
}

/// Pixels are encoded already, so the image's format must not encode them again.
vk::SurfaceFormatKHR chooseFormat(const std::vector<vk::SurfaceFormatKHR>& formats) {
    for (const vk::Format wanted : {vk::Format::eB8G8R8A8Unorm, vk::Format::eR8G8B8A8Unorm}) {
        for (const vk::SurfaceFormatKHR& format : formats) {
            if (format.format == wanted && format.colorSpace == vk::ColorSpaceKHR::eSrgbNonlinear)
                return format;
        }
    }
    throw std::runtime_error("the window takes no 8-bit pictures without conversion");
}

constexpr vk::ImageSubresourceRange kColor{
    .aspectMask = vk::ImageAspectFlagBits::eColor, .levelCount = 1, .layerCount = 1};
constexpr vk::ImageSubresourceLayers kColorLayer{.aspectMask = vk::ImageAspectFlagBits::eColor,
                                                 .layerCount = 1};

struct Transition {
    vk::ImageLayout from, to;
    vk::PipelineStageFlags before, after;
    vk::AccessFlags written, used;
};
void change(vk::CommandBuffer commands, vk::Image image, const Transition& t) {
    const vk::ImageMemoryBarrier barrier{.srcAccessMask = t.written,
                                         .dstAccessMask = t.used,
                                         .oldLayout = t.from,
                                         .newLayout = t.to,
                                         .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                         .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                         .image = image,
                                         .subresourceRange = kColor};
    commands.pipelineBarrier(t.before, t.after, {}, nullptr, nullptr, barrier);
}

std::uint32_t localMemoryType(vk::PhysicalDevice device, std::uint32_t allowed) {
    const vk::PhysicalDeviceMemoryProperties memory = device.getMemoryProperties();
    for (std::uint32_t i = 0; i < memory.memoryTypeCount; ++i) {
        const bool local =
            bool(memory.memoryTypes[i].propertyFlags & vk::MemoryPropertyFlagBits::eDeviceLocal);
        if ((allowed >> i & 1u) != 0 && local) return i;
    }
    throw std::runtime_error("no memory for the picture");
}

}  // namespace

Presenter::Presenter(const gpu::NativeDevice& native, VkSurfaceKHR surface)
    : native_(native),
      device_(native.device),
      queue_(native.queue),
      surface_(surface, vk::Instance(native.instance)) {}

Presenter::~Presenter() {
    try {
        device_.waitIdle();
    } catch (const std::exception&) {  // of a lost device: nothing is under way
    }
}

Result<std::unique_ptr<Presenter>> Presenter::create(const gpu::Device& device, VkSurfaceKHR surface,
                                                     glm::uvec2 windowPixels) {
    std::unique_ptr<Presenter> made(new Presenter(gpu::nativeOf(device), surface));
    PFVOX_CHECK(guarded([&] {
        const vk::PhysicalDevice physical(made->native_.physicalDevice);
        const std::uint32_t family = made->native_.queueFamily;
        if (!physical.getSurfaceSupportKHR(family, surface))
            throw std::runtime_error("the device cannot show pictures in it");
        made->format_ = chooseFormat(physical.getSurfaceFormatsKHR(surface));
        made->createRenderPass();
        made->pool_ = made->device_.createCommandPoolUnique(
            {.flags = vk::CommandPoolCreateFlagBits::eResetCommandBuffer, .queueFamilyIndex = family});
        made->commands_ = std::move(made->device_.allocateCommandBuffersUnique(
            {.commandPool = *made->pool_, .commandBufferCount = 1})[0]);
        made->acquired_ = made->device_.createSemaphoreUnique({});
        made->done_ = made->device_.createFenceUnique({.flags = vk::FenceCreateFlagBits::eSignaled});
        made->recreateSwapchain(windowPixels);
    }));
    return made;
}

void Presenter::createRenderPass() {
    const vk::AttachmentDescription attachment{.format = format_.format,
                                               .samples = vk::SampleCountFlagBits::e1,
                                               .loadOp = vk::AttachmentLoadOp::eLoad,
                                               .storeOp = vk::AttachmentStoreOp::eStore,
                                               .stencilLoadOp = vk::AttachmentLoadOp::eDontCare,
                                               .stencilStoreOp = vk::AttachmentStoreOp::eDontCare,
                                               .initialLayout = vk::ImageLayout::eColorAttachmentOptimal,
                                               .finalLayout = vk::ImageLayout::ePresentSrcKHR};
    const vk::AttachmentReference color{.attachment = 0, .layout = vk::ImageLayout::eColorAttachmentOptimal};
    const auto subpass =
        vk::SubpassDescription{.pipelineBindPoint = vk::PipelineBindPoint::eGraphics}.setColorAttachments(
            color);
    renderPass_ = device_.createRenderPassUnique(
        vk::RenderPassCreateInfo{}.setAttachments(attachment).setSubpasses(subpass));
}

void Presenter::recreateSwapchain(glm::uvec2 windowPixels) {
    device_.waitIdle();
    outdated_ = false;
    const vk::PhysicalDevice physical(native_.physicalDevice);
    const vk::SurfaceCapabilitiesKHR caps = physical.getSurfaceCapabilitiesKHR(*surface_);
    const bool windowDecides = caps.currentExtent.width == std::numeric_limits<std::uint32_t>::max();
    const glm::uvec2 low(caps.minImageExtent.width, caps.minImageExtent.height);
    const glm::uvec2 high(caps.maxImageExtent.width, caps.maxImageExtent.height);
    extent_ = windowDecides ? glm::clamp(windowPixels, low, high)
                            : glm::uvec2(caps.currentExtent.width, caps.currentExtent.height);
    images_.clear();
    if (extent_.x == 0 || extent_.y == 0) {
        swapchain_.reset();
        return;
    }
    const std::uint32_t most = caps.maxImageCount == 0 ? caps.minImageCount + 1 : caps.maxImageCount;
    swapchain_ = device_.createSwapchainKHRUnique(
        {.surface = *surface_,
         .minImageCount = std::min(caps.minImageCount + 1, most),
         .imageFormat = format_.format,
         .imageColorSpace = format_.colorSpace,
         .imageExtent = {extent_.x, extent_.y},
         .imageArrayLayers = 1,
         .imageUsage = vk::ImageUsageFlagBits::eColorAttachment | vk::ImageUsageFlagBits::eTransferDst,
         .imageSharingMode = vk::SharingMode::eExclusive,
         .preTransform = caps.currentTransform,
         .compositeAlpha = vk::CompositeAlphaFlagBitsKHR::eOpaque,
         .presentMode = vk::PresentModeKHR::eFifo,
         .clipped = true,
         .oldSwapchain = *swapchain_});
    for (const vk::Image image : device_.getSwapchainImagesKHR(*swapchain_)) {
        Image made{.image = image, .view = {}, .framebuffer = {}, .drawn = device_.createSemaphoreUnique({})};
        made.view = device_.createImageViewUnique({.image = image,
                                                   .viewType = vk::ImageViewType::e2D,
                                                   .format = format_.format,
                                                   .subresourceRange = kColor});
        made.framebuffer = device_.createFramebufferUnique(vk::FramebufferCreateInfo{
            .renderPass = *renderPass_, .width = extent_.x, .height = extent_.y, .layers = 1}
                                                               .setAttachments(*made.view));
        images_.push_back(std::move(made));
    }
}

void Presenter::ensurePicture(glm::uvec2 size) {
    if (pictureSize_ == size) return;
    device_.waitIdle();
    picture_.reset();
    pictureMemory_.reset();
    picture_ = device_.createImageUnique(
        {.imageType = vk::ImageType::e2D,
         .format = vk::Format::eR8G8B8A8Unorm,
         .extent = {size.x, size.y, 1},
         .mipLevels = 1,
         .arrayLayers = 1,
         .samples = vk::SampleCountFlagBits::e1,
         .tiling = vk::ImageTiling::eOptimal,
         .usage = vk::ImageUsageFlagBits::eTransferSrc | vk::ImageUsageFlagBits::eTransferDst,
         .initialLayout = vk::ImageLayout::eUndefined});
    const vk::MemoryRequirements needs = device_.getImageMemoryRequirements(*picture_);
    pictureMemory_ = device_.allocateMemoryUnique(
        {.allocationSize = needs.size,
         .memoryTypeIndex = localMemoryType(native_.physicalDevice, needs.memoryTypeBits)});
    device_.bindImageMemory(*picture_, *pictureMemory_, 0);
    pictureSize_ = size;
}

void Presenter::copyPicture(const Image& target, const ShownPixels& pixels) {
    using enum vk::ImageLayout;
    const vk::PipelineStageFlags transfer = vk::PipelineStageFlagBits::eTransfer;
    const vk::AccessFlags write = vk::AccessFlagBits::eTransferWrite;
    const vk::CommandBuffer commands = *commands_;
    change(commands, *picture_, {eUndefined, eTransferDstOptimal, transfer, transfer, {}, write});
    const vk::BufferImageCopy whole{.imageSubresource = kColorLayer,
                                    .imageExtent = {pixels.size.x, pixels.size.y, 1}};
    commands.copyBufferToImage(gpu::nativeOf(*pixels.buffer), *picture_, eTransferDstOptimal, whole);
    change(commands, *picture_,
           {eTransferDstOptimal, eTransferSrcOptimal, transfer, transfer, write,
            vk::AccessFlagBits::eTransferRead});
    const auto corner = [](glm::uvec2 size) {
        return vk::Offset3D{static_cast<std::int32_t>(size.x), static_cast<std::int32_t>(size.y), 1};
    };
    const std::array<vk::Offset3D, 2> from{vk::Offset3D{}, corner(pixels.size)};
    const std::array<vk::Offset3D, 2> to{vk::Offset3D{}, corner(extent_)};
    const vk::ImageBlit blit{
        .srcSubresource = kColorLayer, .srcOffsets = from, .dstSubresource = kColorLayer, .dstOffsets = to};
    const vk::Filter filter = pixels.size == extent_ ? vk::Filter::eNearest : vk::Filter::eLinear;
    commands.blitImage(*picture_, eTransferSrcOptimal, target.image, eTransferDstOptimal, blit, filter);
}

void Presenter::record(const Image& target, const ShownPixels& pixels,
                       const std::function<void(VkCommandBuffer)>& drawOverlay) {
    using enum vk::ImageLayout;
    const vk::PipelineStageFlags transfer = vk::PipelineStageFlagBits::eTransfer;
    const vk::CommandBuffer commands = *commands_;
    commands.begin(vk::CommandBufferBeginInfo{.flags = vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
    change(commands, target.image,
           {eUndefined, eTransferDstOptimal, transfer, transfer, {}, vk::AccessFlagBits::eTransferWrite});
    if (pixels.buffer != nullptr) {
        copyPicture(target, pixels);
    } else {
        const vk::ClearColorValue gray(std::array<float, 4>{0.10f, 0.11f, 0.12f, 1.0f});
        commands.clearColorImage(target.image, eTransferDstOptimal, gray, kColor);
    }
    change(commands, target.image,
           {eTransferDstOptimal, eColorAttachmentOptimal, transfer,
            vk::PipelineStageFlagBits::eColorAttachmentOutput, vk::AccessFlagBits::eTransferWrite,
            vk::AccessFlagBits::eColorAttachmentRead | vk::AccessFlagBits::eColorAttachmentWrite});
    commands.beginRenderPass({.renderPass = *renderPass_,
                              .framebuffer = *target.framebuffer,
                              .renderArea = {.extent = {extent_.x, extent_.y}}},
                             vk::SubpassContents::eInline);
    drawOverlay(commands);
    commands.endRenderPass();
    commands.end();
}

void Presenter::waitForFrame() {
    if (device_.waitForFences(*done_, true, kForever) != vk::Result::eSuccess)
        throw vk::DeviceLostError("waiting for a frame");
}

void Presenter::showOrThrow(glm::uvec2 windowPixels, const ShownPixels& pixels,
                            const std::function<void(VkCommandBuffer)>& drawOverlay) {
    waitForFrame();
    if (outdated_ || !swapchain_ || extent_ != windowPixels) recreateSwapchain(windowPixels);
    if (!swapchain_) return;
    if (pixels.buffer != nullptr) ensurePicture(pixels.size);

    std::uint32_t index = 0;
    const vk::Result got = device_.acquireNextImageKHR(*swapchain_, kForever, *acquired_, nullptr, &index);
    outdated_ = got == vk::Result::eErrorOutOfDateKHR || got == vk::Result::eSuboptimalKHR;
    if (got == vk::Result::eErrorOutOfDateKHR) return;  // the next frame makes another
    if (got != vk::Result::eSuccess && got != vk::Result::eSuboptimalKHR)
        throw std::runtime_error("no image: " + vk::to_string(got));

    const Image& target = images_[index];
    record(target, pixels, drawOverlay);
    device_.resetFences(*done_);
    const vk::PipelineStageFlags start = vk::PipelineStageFlagBits::eTransfer;
    queue_.submit(vk::SubmitInfo{.waitSemaphoreCount = 1,
                                 .pWaitSemaphores = &*acquired_,
                                 .pWaitDstStageMask = &start,
                                 .commandBufferCount = 1,
                                 .pCommandBuffers = &*commands_,
                                 .signalSemaphoreCount = 1,
                                 .pSignalSemaphores = &*target.drawn},
                  *done_);
    const vk::PresentInfoKHR present{.waitSemaphoreCount = 1,
                                     .pWaitSemaphores = &*target.drawn,
                                     .swapchainCount = 1,
                                     .pSwapchains = &*swapchain_,
                                     .pImageIndices = &index};
    const vk::Result shown = queue_.presentKHR(&present);
    if (shown == vk::Result::eErrorOutOfDateKHR || shown == vk::Result::eSuboptimalKHR) {
        outdated_ = true;
    } else if (shown != vk::Result::eSuccess) {
        throw std::runtime_error("cannot show: " + vk::to_string(shown));
    }
}

Result<void> Presenter::show(glm::uvec2 windowPixels, const ShownPixels& pixels,
                             const std::function<void(VkCommandBuffer)>& drawOverlay) {
    if (windowPixels.x == 0 || windowPixels.y == 0) return {};
    return guarded([&] { showOrThrow(windowPixels, pixels, drawOverlay); });
}

Result<void> Presenter::finish() {
    return guarded([&] { waitForFrame(); });
}

Result<void> Presenter::runOnce(const std::function<void(VkCommandBuffer)>& record) {
    return guarded([&] {
        waitForFrame();
        commands_->begin(vk::CommandBufferBeginInfo{.flags = vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
        record(*commands_);
        commands_->end();
        device_.resetFences(*done_);
        queue_.submit(vk::SubmitInfo{.commandBufferCount = 1, .pCommandBuffers = &*commands_}, *done_);
        waitForFrame();
    });
}

}  // namespace pfvox::viewer
