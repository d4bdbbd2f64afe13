#include "gpu/instance.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstring>
#include <optional>
#include <pfvox/gpu_native.hpp>

namespace pfvox::gpu {

const char* toString(DeviceKind kind) {
    switch (kind) {
        case DeviceKind::Discrete:
            return "discrete";
        case DeviceKind::Integrated:
            return "integrated";
        case DeviceKind::Virtual:
            return "virtual";
        case DeviceKind::Other:
            return "other";
        case DeviceKind::Software:
            return "software";
    }
    return "unknown";
}

}  // namespace pfvox::gpu

namespace pfvox::gpu::detail {

namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";

VKAPI_ATTR VkBool32 VKAPI_CALL onMessage(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                         VkDebugUtilsMessageTypeFlagsEXT,
                                         const VkDebugUtilsMessengerCallbackDataEXT* data, void* log) {
    static_cast<ValidationLog*>(log)->add(data->pMessage);
    return VK_FALSE;
}

vk::DebugUtilsMessengerCreateInfoEXT messengerInfo(ValidationLog& log) {
    return {.messageSeverity = vk::DebugUtilsMessageSeverityFlagBitsEXT::eWarning |
                               vk::DebugUtilsMessageSeverityFlagBitsEXT::eError,
            .messageType = vk::DebugUtilsMessageTypeFlagBitsEXT::eValidation |
                           vk::DebugUtilsMessageTypeFlagBitsEXT::ePerformance,
            .pfnUserCallback = onMessage,
            .pUserData = &log};
}

bool hasLayer(const vk::raii::Context& context, const char* name) {
    return std::ranges::any_of(
        context.enumerateInstanceLayerProperties(),
        [&](const vk::LayerProperties& layer) { return std::strcmp(layer.layerName, name) == 0; });
}

DeviceKind kindOf(vk::PhysicalDeviceType type) {
    switch (type) {
        case vk::PhysicalDeviceType::eDiscreteGpu:
            return DeviceKind::Discrete;
        case vk::PhysicalDeviceType::eIntegratedGpu:
            return DeviceKind::Integrated;
        case vk::PhysicalDeviceType::eVirtualGpu:
            return DeviceKind::Virtual;
        case vk::PhysicalDeviceType::eCpu:
            return DeviceKind::Software;
        default:
            return DeviceKind::Other;
    }
}

/// The first family that computes, draws and fits.
std::optional<std::uint32_t> fittingFamily(const vk::raii::PhysicalDevice& device, VkInstance instance,
                                           const DeviceOptions& options) {
    const std::vector<vk::QueueFamilyProperties> families = device.getQueueFamilyProperties();
    const vk::QueueFlags needed = vk::QueueFlagBits::eCompute | vk::QueueFlagBits::eGraphics;
    for (std::uint32_t i = 0; i < families.size(); ++i) {
        if ((families[i].queueFlags & needed) != needed) continue;
        if (options.queueFits({.instance = instance, .physicalDevice = *device, .index = i})) return i;
    }
    return std::nullopt;
}

/// A family that computes; one without graphics before others, because it competes with nobody.
std::optional<std::uint32_t> computeFamily(const vk::raii::PhysicalDevice& device) {
    const std::vector<vk::QueueFamilyProperties> families = device.getQueueFamilyProperties();
    std::optional<std::uint32_t> any;
    for (std::uint32_t i = 0; i < families.size(); ++i) {
        if (!(families[i].queueFlags & vk::QueueFlagBits::eCompute)) continue;
        if (!(families[i].queueFlags & vk::QueueFlagBits::eGraphics)) return i;
        if (!any) any = i;
    }
    return any;
}

/// The first of these extensions that the device lacks; empty = none.
std::string missingExtension(const vk::raii::PhysicalDevice& device, const std::vector<std::string>& wanted) {
    if (wanted.empty()) return {};
    const std::vector<vk::ExtensionProperties> there = device.enumerateDeviceExtensionProperties();
    for (const std::string& name : wanted) {
        const auto isIt = [&](const vk::ExtensionProperties& e) { return name == e.extensionName.data(); };
        if (std::ranges::none_of(there, isIt)) return name;
    }
    return {};
}

std::string missingOf(const vk::raii::PhysicalDevice& device, std::optional<std::uint32_t> family,
                      const DeviceOptions& options) {
    if (device.getProperties().apiVersion < VK_API_VERSION_1_2) return "Vulkan 1.2";
    const auto chain = device.getFeatures2<vk::PhysicalDeviceFeatures2, vk::PhysicalDeviceVulkan12Features>();
    const auto& features = chain.get<vk::PhysicalDeviceVulkan12Features>();
    if (!features.bufferDeviceAddress) return "bufferDeviceAddress";
    if (!features.timelineSemaphore) return "timelineSemaphore";
    if (!family) return options.queueFits ? "a queue that computes and shows pictures" : "a compute queue";
    return missingExtension(device, options.deviceExtensions);
}

std::uint64_t localMemoryBytes(const vk::raii::PhysicalDevice& device) {
    const vk::PhysicalDeviceMemoryProperties memory = device.getMemoryProperties();
    std::uint64_t largest = 0;
    for (std::uint32_t i = 0; i < memory.memoryHeapCount; ++i) {
        const vk::MemoryHeap& heap = memory.memoryHeaps[i];
        if (heap.flags & vk::MemoryHeapFlagBits::eDeviceLocal)
            largest = std::max<std::uint64_t>(largest, heap.size);
    }
    return largest;
}

std::string driverOf(const vk::raii::PhysicalDevice& device) {
    if (device.getProperties().apiVersion < VK_API_VERSION_1_2) return "unknown";
    const auto chain =
        device.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceDriverProperties>();
    const auto& driver = chain.get<vk::PhysicalDeviceDriverProperties>();
    return fmt::format("{} {}", driver.driverName.data(), driver.driverInfo.data());
}

FoundDevice describeDevice(vk::raii::PhysicalDevice physical, std::uint32_t index, VkInstance instance,
                           const DeviceOptions& options) {
    const vk::PhysicalDeviceProperties properties = physical.getProperties();
    const std::optional<std::uint32_t> family =
        options.queueFits ? fittingFamily(physical, instance, options) : computeFamily(physical);
    DeviceInfo info{.index = index,
                    .name = properties.deviceName.data(),
                    .kind = kindOf(properties.deviceType),
                    .driver = driverOf(physical),
                    .apiVersionMajor = VK_API_VERSION_MAJOR(properties.apiVersion),
                    .apiVersionMinor = VK_API_VERSION_MINOR(properties.apiVersion),
                    .localMemoryBytes = localMemoryBytes(physical),
                    .missing = missingOf(physical, family, options)};
    return {.info = std::move(info), .physical = std::move(physical), .queueFamily = family.value_or(0)};
}

std::string lowerCase(std::string text) {
    std::ranges::transform(text, text.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

std::string listed(const std::vector<FoundDevice>& devices) {
    std::string text;
    for (const FoundDevice& device : devices) {
        text += fmt::format("{}{}: {}", text.empty() ? "" : ", ", device.info.index, device.info.name);
        if (!device.info.usable()) text += fmt::format(" (lacks {})", device.info.missing);
    }
    return text.empty() ? "none" : text;
}

std::optional<std::size_t> bestDevice(const std::vector<FoundDevice>& devices) {
    std::optional<std::size_t> best;
    for (std::size_t i = 0; i < devices.size(); ++i) {
        if (!devices[i].info.usable()) continue;
        if (!best || devices[i].info.kind < devices[*best].info.kind) best = i;
    }
    return best;
}

std::optional<std::size_t> matchingDevice(const std::vector<FoundDevice>& devices,
                                          const std::string& selector) {
    std::size_t index = 0;
    const char* end = selector.data() + selector.size();
    const auto [rest, error] = std::from_chars(selector.data(), end, index);
    if (error == std::errc{} && rest == end && index < devices.size()) return index;
    for (std::size_t i = 0; i < devices.size(); ++i) {
        if (lowerCase(devices[i].info.name).find(lowerCase(selector)) != std::string::npos) return i;
    }
    return std::nullopt;
}

}  // namespace

void ValidationLog::add(std::string message) {
    const std::scoped_lock lock(mutex_);
    messages_.push_back(std::move(message));
}

std::vector<std::string> ValidationLog::messages() const {
    const std::scoped_lock lock(mutex_);
    return messages_;
}

std::vector<const char*> pointersTo(const std::vector<std::string>& texts) {
    std::vector<const char*> pointers;
    for (const std::string& text : texts) pointers.push_back(text.c_str());
    return pointers;
}

Result<Instance> createInstance(const DeviceOptions& options) {
    const bool validation = options.validation;
    return guarded("cannot start Vulkan", [&] {
        Instance made{.context = {}, .log = std::make_unique<ValidationLog>()};
        if (validation && !hasLayer(made.context, kValidationLayer)) {
            throw std::runtime_error(
                "VK_LAYER_KHRONOS_validation is not installed (Debian: vulkan-validationlayers)");
        }
        const vk::ApplicationInfo application{
            .pApplicationName = "pfvox", .pEngineName = "pfvox", .apiVersion = VK_API_VERSION_1_2};
        const std::array layers{kValidationLayer};
        std::vector<const char*> extensions = pointersTo(options.instanceExtensions);
        if (validation) extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
        const vk::DebugUtilsMessengerCreateInfoEXT messenger = messengerInfo(*made.log);
        vk::InstanceCreateInfo info{.pApplicationInfo = &application};
        if (validation) {
            info.pNext = &messenger;  // covers the creation of the instance itself
            info.setPEnabledLayerNames(layers);
        }
        info.setPEnabledExtensionNames(extensions);
        try {
            made.instance = vk::raii::Instance(made.context, info);
        } catch (const vk::IncompatibleDriverError&) {
            throw std::runtime_error(
                "no Vulkan driver is installed; llvmpipe runs on every processor (Debian: "
                "mesa-vulkan-drivers)");
        }
        if (validation) made.messenger = vk::raii::DebugUtilsMessengerEXT(made.instance, messenger);
        return made;
    });
}

Result<std::vector<FoundDevice>> findDevices(const Instance& instance, const DeviceOptions& options) {
    return guarded("cannot list Vulkan devices", [&] {
        std::vector<FoundDevice> devices;
        for (vk::raii::PhysicalDevice& physical : vk::raii::PhysicalDevices(instance.instance)) {
            devices.push_back(describeDevice(std::move(physical), static_cast<std::uint32_t>(devices.size()),
                                             *instance.instance, options));
        }
        return devices;
    });
}

Result<std::size_t> selectDevice(const std::vector<FoundDevice>& devices, const std::string& selector) {
    const std::optional<std::size_t> chosen =
        selector.empty() ? bestDevice(devices) : matchingDevice(devices, selector);
    if (!chosen) {
        const std::string wanted =
            selector.empty() ? "no usable Vulkan device" : "no Vulkan device '" + selector + "'";
        return fail(ErrorCode::GpuUnavailable, fmt::format("{}; there is: {}", wanted, listed(devices)));
    }
    const DeviceInfo& info = devices[*chosen].info;
    if (!info.usable()) {
        return fail(ErrorCode::GpuUnavailable, fmt::format("device '{}' lacks {}", info.name, info.missing));
    }
    return *chosen;
}

}  // namespace pfvox::gpu::detail
