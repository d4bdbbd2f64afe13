// Memory and the buffer in it.
#pragma once

#include <cstddef>
#include <cstdint>

#include "gpu/vulkan.hpp"

namespace pfvox::gpu::detail {

struct Allocation {
    vk::raii::DeviceMemory memory{nullptr};
    vk::raii::Buffer buffer{nullptr};
    std::uint64_t sizeBytes = 0;
    std::byte* mapped = nullptr;  ///< null for device memory
};

}  // namespace pfvox::gpu::detail
