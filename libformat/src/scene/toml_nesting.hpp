// How deeply a TOML text nests, found without building anything.
//
// toml++ bounds nested values but not dotted keys: a.a.a... of a megabyte becomes tables in tables whose
// destruction overflows the stack. This looks before it parses.
#pragma once

#include <compare>
#include <cstdint>
#include <optional>
#include <string_view>

namespace pfvox::scene {

struct TextPlace {
    std::uint32_t line = 1;
    std::uint32_t column = 1;  ///< in code points
    auto operator<=>(const TextPlace&) const = default;
};

inline constexpr int kMaxNesting = 32;  ///< open brackets, and segments of one key

/// The first place where the text nests deeper than kMaxNesting.
std::optional<TextPlace> tooDeepAt(std::string_view text);

/// Line and column of a byte.
TextPlace placeOf(std::string_view text, std::size_t offset);

/// From places to bytes, for places in the order of the text: all of them cost one walk.
class PlaceFinder {
  public:
    explicit PlaceFinder(std::string_view text);
    /// npos where there is no such place, or it lies before the last one.
    std::size_t find(TextPlace place);

  private:
    std::string_view text_;
    std::size_t at_ = 0;
    TextPlace place_;
};

}  // namespace pfvox::scene
