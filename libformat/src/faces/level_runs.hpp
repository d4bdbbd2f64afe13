// LevelRuns: the levels of a chunk's faces as runs. Nearly all are 0, so they cost next to nothing.
#pragma once

#include <cstdint>
#include <pfvox/error.hpp>
#include <span>
#include <vector>

namespace pfvox::faces {

/// For each run a number of 7 bits a byte, low ones first, bit 7 = one more byte follows: length << 3 |
/// level, 4 for kNoFaceValue. Never longer than the levels. Precondition: they are levels.
std::vector<std::uint8_t> toRuns(std::span<const std::uint8_t> levels);

/// Fills `levels`. Errors: BadStructure (not their runs), BadValue (unknown level).
Result<void> fromRuns(std::span<const std::byte> runs, std::span<std::uint8_t> levels);

}  // namespace pfvox::faces
