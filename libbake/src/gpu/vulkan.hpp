// The one place that includes vulkan_raii.hpp, and the border at which its exceptions become errors.
#pragma once

#include <pfvox/error.hpp>
#include <string>
#include <type_traits>
#include <utility>
#include <vulkan/vulkan_raii.hpp>

namespace pfvox::gpu::detail {

/// Calls f and turns what Vulkan throws into an Error; `what` begins its message.
template <class F>
Result<std::invoke_result_t<F>> guarded(const std::string& what, F&& f) {
    try {
        if constexpr (std::is_void_v<std::invoke_result_t<F>>) {
            std::forward<F>(f)();
            return {};
        } else {
            return std::forward<F>(f)();
        }
    } catch (const vk::OutOfDeviceMemoryError& error) {
        return fail(ErrorCode::GpuOutOfMemory, what + ": " + error.what());
    } catch (const vk::OutOfHostMemoryError& error) {
        return fail(ErrorCode::GpuOutOfMemory, what + ": " + error.what());
    } catch (const vk::DeviceLostError& error) {
        return fail(ErrorCode::GpuLost, what + ": " + error.what());
    } catch (
        const std::exception& error) {  // vk::SystemError, and the loader's absence as std::runtime_error
        return fail(ErrorCode::GpuUnavailable, what + ": " + error.what());
    }
}

}  // namespace pfvox::gpu::detail
