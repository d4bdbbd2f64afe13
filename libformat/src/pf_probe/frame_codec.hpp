// FrameCodec: the map of one probe <-> its frame.
#pragma once

#include <pfvox/error.hpp>
#include <pfvox/pf_probe.hpp>
#include <span>
#include <vector>

#include "container/memory_budget.hpp"
#include "pf_probe/layout.hpp"

namespace pfvox::probe {

/// Bytes of one word of a layer.
constexpr std::size_t wordBytesOf(ProbeLayer layer) {
    return layer == ProbeLayer::MinDepth ? 2 : 4;
}

/// The frame's entry and, appended to `stored`, its bytes: compressed where that makes them fewer.
/// Errors: Internal when zstd fails.
Result<probe_layout::Frame> packFrame(ProbeLayer layer, std::span<const std::byte> words, int zstdLevel,
                                      std::vector<std::byte>& stored);

/// Fills `words` and checks their hash. Errors: BadStructure (the frame does not hold so many bytes),
/// ChecksumMismatch, LimitExceeded.
Result<void> unpackFrame(ProbeLayer layer, const probe_layout::Frame& frame,
                         std::span<const std::byte> stored, std::span<std::byte> words,
                         container::MemoryBudget& budget);

/// "raw", "predicted".
std::string_view toString(probe_layout::FrameCodec codec);
/// Precondition: one of those.
probe_layout::FrameCodec codecOf(std::string_view name);

}  // namespace pfvox::probe
