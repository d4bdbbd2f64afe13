// Text encoding: names in source files are bytes of unknown code pages; names in ours are UTF-8.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace pfvox {

/// A code point at the front of a text.
struct CodePoint {
    char32_t value = 0;     ///< Unicode scalar value
    std::size_t bytes = 0;  ///< that it takes; 0 where the text is empty or does not begin with valid UTF-8
};
CodePoint firstCodePoint(std::string_view text);  ///< overlong forms and surrogates are not valid

bool isUtf8(std::string_view text);

/// UTF-8 of a code point up to U+10FFFF.
std::string utf8Of(char32_t codePoint);

/// Every byte read as a character of Windows-1252, of which Latin-1 is nearly a part; the five bytes without
/// one become U+FFFD.
std::string utf8FromWindows1252(std::string_view bytes);

}  // namespace pfvox
