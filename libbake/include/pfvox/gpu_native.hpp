// GpuNative: the Vulkan objects under a Device, for programs that use it beside pfvox, above all to show
// pictures in a window. Nothing here needs a Vulkan header; include <vulkan/vulkan.h> to do something with
// the handles.
//
// Whoever submits to the queue does so from the thread that uses the Device. Device::run has finished when it
// returns, and what it wrote is visible to later copies and shaders on the same queue.
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
    VkInstance_T* instance = nullptr;              ///< the one that was asked for
    VkPhysicalDevice_T* physicalDevice = nullptr;  ///< the one that was chosen
    std::uint32_t index = 0;                       ///< of the queue family
};

/// They live as long as the Device and are not to be destroyed.
struct NativeDevice {
    VkInstance_T* instance = nullptr;              ///< owned by the Device
    VkPhysicalDevice_T* physicalDevice = nullptr;  ///< owned by the Device
    VkDevice_T* device = nullptr;                  ///< owned by the Device
    VkQueue_T* queue = nullptr;                    ///< the one that run() uses
    std::uint32_t queueFamily = 0;                 ///< of the queue that computes
};
NativeDevice nativeOf(const Device& device);  ///< valid as long as the device

/// A buffer that may be copied from and to.
VkBuffer_T* nativeOf(const Buffer& buffer);

}  // namespace pfvox::gpu
