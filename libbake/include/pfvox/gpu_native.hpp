// GpuNative: the Vulkan objects under a Device, for programs that use it beside pfvox, above all to show pictures in a
// window. Nothing here needs a Vulkan header; include <vulkan/vulkan.h> to do something with the handles.
//
// Whoever submits to the queue does so from the thread that uses the Device. Device::run has finished when it returns,
// and what it wrote is visible to later copies and shaders on the same queue.
#pragma once

#include <cstdint>
#include <pfvox/gpu.hpp>

struct VkInstance_T;
struct VkPhysicalDevice_T;
struct VkDevice_T;
struct VkQueue_T;
struct VkBuffer_T;

namespace pfvox::gpu {

/// A queue family, before a device is opened (DeviceOptions::queueFits).
struct NativeQueueFamily {
    VkInstance_T* instance = nullptr;
    VkPhysicalDevice_T* physicalDevice = nullptr;
    std::uint32_t index = 0;
};

/// They live as long as the Device and are not to be destroyed.
struct NativeDevice {
    VkInstance_T* instance = nullptr;
    VkPhysicalDevice_T* physicalDevice = nullptr;
    VkDevice_T* device = nullptr;
    VkQueue_T* queue = nullptr;  ///< the one that run() uses
    std::uint32_t queueFamily = 0;
};
NativeDevice nativeOf(const Device& device);

/// A buffer that may be copied from and to.
VkBuffer_T* nativeOf(const Buffer& buffer);

}  // namespace pfvox::gpu
