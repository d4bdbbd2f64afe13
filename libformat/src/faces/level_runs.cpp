#include "faces/level_runs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <pfvox/face_light.hpp>

namespace pfvox::faces {

namespace {

constexpr std::uint64_t kNoValueCode = 4;
constexpr unsigned kCodeBits = 3;
constexpr unsigned kMaxNumberBits = 35;  ///< 32 of the length

void append(std::vector<std::uint8_t>& bytes, std::uint64_t number) {
    for (; number > 0x7f; number >>= 7) bytes.push_back(static_cast<std::uint8_t>(number | 0x80));
    bytes.push_back(static_cast<std::uint8_t>(number));
}

/// The next number, or nothing where there is none that append() writes.
std::optional<std::uint64_t> take(std::span<const std::byte>& bytes) {
    std::uint64_t number = 0;
    for (unsigned shift = 0; shift < kMaxNumberBits && !bytes.empty(); shift += 7) {
        const auto byte = static_cast<std::uint8_t>(bytes[0]);
        bytes = bytes.subspan(1);
        number |= std::uint64_t{byte & 0x7fu} << shift;
        if (byte < 0x80) return byte != 0 || shift == 0 ? std::optional(number) : std::nullopt;
    }
    return std::nullopt;
}

}  // namespace

std::vector<std::uint8_t> toRuns(std::span<const std::uint8_t> levels) {
    std::vector<std::uint8_t> runs;
    for (std::size_t i = 0; i < levels.size();) {
        std::size_t end = i;
        while (end < levels.size() && levels[end] == levels[i]) ++end;
        const std::uint64_t code = levels[i] == kNoFaceValue ? kNoValueCode : levels[i];
        append(runs, std::uint64_t{end - i} << kCodeBits | code);
        i = end;
    }
    return runs;
}

Result<void> fromRuns(std::span<const std::byte> runs, std::span<std::uint8_t> levels) {
    std::size_t next = 0;
    std::optional<std::uint64_t> before;
    while (!runs.empty()) {
        const auto number = take(runs);
        if (!number) return fail(ErrorCode::BadStructure, "levels: a run is no number");
        const std::uint64_t code = *number & ((1u << kCodeBits) - 1);
        const std::uint64_t length = *number >> kCodeBits;
        if (code > kNoValueCode)
            return fail(ErrorCode::BadValue, fmt::format("levels: unknown level {}", code));
        if (length == 0 || code == before || length > levels.size() - next)
            return fail(ErrorCode::BadStructure, fmt::format("levels: a run of {} at face {}", length, next));
        const auto level = code == kNoValueCode ? kNoFaceValue : static_cast<std::uint8_t>(code);
        std::ranges::fill(levels.subspan(next, length), level);
        next += length;
        before = code;
    }
    if (next == levels.size()) return {};
    return fail(ErrorCode::BadStructure, fmt::format("levels: {} of {} faces", next, levels.size()));
}

}  // namespace pfvox::faces
