// How deeply a TOML text nests, found without building anything.
//
// toml++ bounds nested values but not dotted keys: a.a.a... of a megabyte becomes tables in tables whose
// destruction overflows the stack. This looks before it parses.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace pfvox::scene {

struct TextPlace {
    std::uint32_t line = 1;
    std::uint32_t column = 1;  ///< in code points
    bool operator==(const TextPlace&) const = default;
};

inline constexpr int kMaxNesting = 32;  ///< open brackets, and segments of one key

/// The first place where the text nests deeper than kMaxNesting.
std::optional<TextPlace> tooDeepAt(std::string_view text);

/// Line and column of a byte, and back: npos where there is no such place.
TextPlace placeOf(std::string_view text, std::size_t offset);
std::size_t offsetOf(std::string_view text, TextPlace place);

}  // namespace pfvox::scene
