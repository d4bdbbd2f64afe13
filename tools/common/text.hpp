// Text for people: quantities, plurals, widths and the nearest word to a misspelt one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace pfvox::tools {

/// "512 B", "1.4 KiB", "23.0 MiB".
std::string formatBytes(std::uint64_t bytes);

/// "1,234,567".
std::string formatCount(std::uint64_t count);

/// "850", "12.3 thousand", "4.1 million": for rates and running totals.
std::string formatRoughly(double count);

/// "1 file", "3 files".
std::string plural(std::uint64_t count, std::string_view singular);

/// "0.42 s", "3 min 05 s".
std::string formatDuration(double seconds);

/// Columns that UTF-8 text takes on a terminal, counting one for each code point.
std::size_t displayWidth(std::string_view utf8);

/// A to Z become a to z; other characters stay.
std::string lowerCase(std::string_view text);

/// Text from outside (names, paths, messages about them) as one line that is safe to show: line ends, control
/// characters, marks that turn the direction of writing and bytes that are not UTF-8 become \n, \x1b,
/// \u{202e}.
std::string escaped(std::string_view text);

/// The candidate that takes the fewest insertions, deletions, replacements and swaps of neighbors to reach,
/// if it is near enough to be what the user meant. Case does not matter; the beginning of a word counts as
/// near.
std::optional<std::string> nearestWord(std::string_view word, std::span<const std::string> candidates);

/// Whether a shell pattern fits a path with '/' separators. `*` and `?` stay within a folder, `**` crosses
/// folders. A pattern without '/' is matched against the file name alone.
bool globMatches(std::string_view pattern, std::string_view path);

}  // namespace pfvox::tools
