// Pictures as PNG files.
#pragma once

#include <cstddef>
#include <filesystem>
#include <pfvox/error.hpp>
#include <span>
#include <vector>

#include "picture.hpp"

namespace pfvox::viewer {

/// 8-bit RGBA without time stamps or text: equal pictures give equal bytes.
Result<std::vector<std::byte>> encodePng(const Picture& picture);

/// Any PNG as 8-bit RGBA. Errors: BadValue, LimitExceeded (edges above 16384).
Result<Picture> decodePng(std::span<const std::byte> bytes);

/// The file appears complete or not at all. Errors: FileNotWritable.
Result<void> writePng(const std::filesystem::path& file, const Picture& picture);

/// Errors: FileNotFound, FileNotReadable, those of decodePng.
Result<Picture> readPng(const std::filesystem::path& file);

}  // namespace pfvox::viewer
