// Picture files: what verify writes, as PNG.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <pfvox/error.hpp>
#include <span>

namespace pfvox::tools {

/// 8-bit sRGB of linear colors, rows from the top; equal pictures give equal bytes. Errors: FileNotWritable.
Result<void> writePicture(const std::filesystem::path& file, glm::uvec2 size,
                          std::span<const glm::vec3> linear);

/// Dark blue for 0 over green and yellow to white for 1.
glm::vec3 heatColor(float value);

}  // namespace pfvox::tools
