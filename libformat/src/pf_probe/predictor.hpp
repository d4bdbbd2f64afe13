// Predictor: the words of a map as differences to what their neighbors foretell, which are small numbers
// where surfaces are flat and light is smooth; sorted into planes of bytes for zstd. Lossless, integers only.
//
// A word has fields (shaders/shared/probe_maths.glsl.h). For each field, with arithmetic modulo 2^bits:
//     foretold = left + up - upLeft   (depth codes; left or up alone on the first row or column, 0 at the
//     first texel)
//              = left                 (all others; up on the first column)
//     residual = zigzag(value - foretold)        0, -1, 1, -2, ... -> 0, 1, 2, 3, ...
// The low bytes of all residuals of a field form a plane; those above 8 bits have a second one of their high
// bytes.
#pragma once

#include <cstddef>
#include <pfvox/pf_probe.hpp>
#include <span>
#include <vector>

namespace pfvox::probe {

/// Bytes of all planes of a map of edge * edge texels.
std::uint64_t planeBytes(ProbeLayer layer, std::uint32_t edge);

/// The planes of a map. `words` holds edge * edge words of the layer.
std::vector<std::byte> toPlanes(ProbeLayer layer, std::span<const std::byte> words, std::uint32_t edge);

/// The inverse. Preconditions: sizes of both.
void fromPlanes(ProbeLayer layer, std::span<const std::byte> planes, std::uint32_t edge,
                std::span<std::byte> words);

}  // namespace pfvox::probe
