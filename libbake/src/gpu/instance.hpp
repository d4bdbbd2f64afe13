// The Vulkan instance, the validation layer and the devices that are there.
#pragma once

#include <memory>
#include <mutex>
#include <pfvox/gpu.hpp>
#include <vector>

#include "gpu/vulkan.hpp"

namespace pfvox::gpu::detail {

/// Collects what the validation layer says; called from whatever thread is inside Vulkan.
class ValidationLog {
  public:
    void add(std::string message);
    std::vector<std::string> messages() const;

  private:
    mutable std::mutex mutex_;
    std::vector<std::string> messages_;
};

struct Instance {
    vk::raii::Context context;
    std::unique_ptr<ValidationLog> log;  // at a fixed address: the messenger points to it
    vk::raii::Instance instance{nullptr};
    vk::raii::DebugUtilsMessengerEXT messenger{nullptr};
};

/// Errors: GpuUnavailable, also when validation is asked for and its layer is not installed, or an extension
/// is missing.
Result<Instance> createInstance(const DeviceOptions& options);

struct FoundDevice {
    DeviceInfo info;
    vk::raii::PhysicalDevice physical{nullptr};
    std::uint32_t queueFamily = 0;
};
Result<std::vector<FoundDevice>> findDevices(const Instance& instance, const DeviceOptions& options);

/// Of texts that outlive them.
std::vector<const char*> pointersTo(const std::vector<std::string>& texts);

/// Position of the device that the selector means (DeviceOptions::selector).
Result<std::size_t> selectDevice(const std::vector<FoundDevice>& devices, const std::string& selector);

}  // namespace pfvox::gpu::detail
