// ValuePlanes: values <-> planes of bytes that compress well. A value is told by its difference from the one
// before it; docs/format-pf_probe.md has the planes.
#pragma once

#include <cstdint>
#include <pfvox/error.hpp>
#include <pfvox/face_light.hpp>
#include <span>
#include <vector>

namespace pfvox::faces {

inline constexpr std::size_t kMaxPlanes = 5;
constexpr std::size_t planeCount(FaceCodec codec) {
    return codec == FaceCodec::Quantized ? 4 : 5;
}

/// planeCount() planes of a byte a value. Precondition: no exponent is 31.
std::vector<std::uint8_t> toPlanes(FaceCodec codec, std::span<const std::uint32_t> values);

/// Fills `values`. Precondition: planeCount() bytes for each of them. Errors: BadValue.
Result<void> fromPlanes(FaceCodec codec, std::span<const std::byte> planes, std::span<std::uint32_t> values);

}  // namespace pfvox::faces
