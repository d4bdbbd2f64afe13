// Presenter: shows pixels that were computed on a device in a window: surface, swapchain and one command
// buffer a frame.
//
//     pixels (buffer) -> image -> scaled into the swapchain's image -> overlay drawn upon it -> screen
#pragma once

#include <vulkan/vulkan.hpp>

#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <pfvox/gpu_native.hpp>
#include <vector>

namespace pfvox::viewer {

/// Pixels as FrameSequence makes them; a null buffer = nothing to show yet.
struct ShownPixels {
    const gpu::Buffer* buffer = nullptr;
    glm::uvec2 size{0};
};

class Presenter {
  public:
    /// Takes the surface over; it was made for the device's instance. Errors: GpuUnavailable.
    static Result<std::unique_ptr<Presenter>> create(const gpu::Device& device, VkSurfaceKHR surface,
                                                     glm::uvec2 windowPixels);
    ~Presenter();
    Presenter(const Presenter&) = delete;
    Presenter& operator=(const Presenter&) = delete;

    /// Waits until the frame that was shown last uses no pixels any more. Errors: as show().
    Result<void> finish();
    /// Waits for the frame before, then draws and shows one. Does nothing while the window has no area.
    /// Errors: GpuLost, GpuUnavailable.
    Result<void> show(glm::uvec2 windowPixels, const ShownPixels& pixels,
                      const std::function<void(VkCommandBuffer)>& drawOverlay);
    /// Records commands, runs them and waits. Errors: as show().
    Result<void> runOnce(const std::function<void(VkCommandBuffer)>& record);

    const gpu::NativeDevice& native() const { return native_; }
    VkRenderPass renderPass() const { return *renderPass_; }
    std::uint32_t imageCount() const { return static_cast<std::uint32_t>(images_.size()); }

  private:
    struct Image {
        vk::Image image;
        vk::UniqueImageView view;
        vk::UniqueFramebuffer framebuffer;
        vk::UniqueSemaphore drawn;
    };
    Presenter(const gpu::NativeDevice& native, VkSurfaceKHR surface);
    void createRenderPass();
    void recreateSwapchain(glm::uvec2 windowPixels);
    void ensurePicture(glm::uvec2 size);
    void record(const Image& target, const ShownPixels& pixels,
                const std::function<void(VkCommandBuffer)>& drawOverlay);
    void copyPicture(const Image& target, const ShownPixels& pixels);
    void showOrThrow(glm::uvec2 windowPixels, const ShownPixels& pixels,
                     const std::function<void(VkCommandBuffer)>& drawOverlay);
    void waitForFrame();

    gpu::NativeDevice native_;
    vk::Device device_;
    vk::Queue queue_;
    vk::UniqueSurfaceKHR surface_;
    vk::SurfaceFormatKHR format_;
    vk::UniqueRenderPass renderPass_;
    vk::UniqueCommandPool pool_;
    vk::UniqueCommandBuffer commands_;
    vk::UniqueSemaphore acquired_;
    vk::UniqueFence done_;
    vk::UniqueSwapchainKHR swapchain_;
    glm::uvec2 extent_{0};
    std::vector<Image> images_;
    vk::UniqueDeviceMemory pictureMemory_;
    vk::UniqueImage picture_;
    glm::uvec2 pictureSize_{0};
    bool outdated_ = false;
};

}  // namespace pfvox::viewer
