#include "scene/toml_nesting.hpp"

#include <algorithm>

namespace pfvox::scene {

namespace {

bool continuesCodePoint(char c) {
    return (static_cast<unsigned char>(c) & 0xc0u) == 0x80u;
}

/// The byte after the string that begins at `at`. Strings of one line end at its end, closed or not.
std::size_t endOfString(std::string_view text, std::size_t at) {
    const char quote = text[at];
    const std::string_view triple = quote == '"' ? "\"\"\"" : "'''";
    const bool multiLine = text.substr(at, 3) == triple;
    at += multiLine ? 3 : 1;
    while (at < text.size()) {
        if (quote == '"' && text[at] == '\\') {
            at += 2;
        } else if (multiLine && text.substr(at, 3) == triple) {
            at += 3;
            // Up to two quotes may stand right before the closing three.
            for (int i = 0; i < 2 && at < text.size() && text[at] == quote; ++i) ++at;
            return at;
        } else if (!multiLine && (text[at] == quote || text[at] == '\n')) {
            return at + 1;
        } else {
            ++at;
        }
    }
    return text.size();
}

}  // namespace

std::optional<TextPlace> tooDeepAt(std::string_view text) {
    int brackets = 0;
    int dots = 0;
    for (std::size_t at = 0; at < text.size();) {
        const char c = text[at];
        if (c == '"' || c == '\'') {
            at = endOfString(text, at);
            continue;
        }
        if (c == '#') {
            at = std::min(text.find('\n', at), text.size());
            continue;
        }
        if (c == '.') {
            ++dots;
        } else if (c == '[' || c == '{') {
            ++brackets;
            dots = 0;
        } else if (c == ']' || c == '}') {
            brackets = std::max(brackets - 1, 0);
            dots = 0;
        } else if (c == '=' || c == ',' || c == '\n') {
            dots = 0;
        }
        if (brackets > kMaxNesting || dots >= kMaxNesting) return placeOf(text, at);
        ++at;
    }
    return std::nullopt;
}

TextPlace placeOf(std::string_view text, std::size_t offset) {
    TextPlace place;
    for (const char c : text.substr(0, offset)) {
        if (c == '\n') {
            ++place.line;
            place.column = 1;
        } else if (!continuesCodePoint(c)) {
            ++place.column;
        }
    }
    return place;
}

PlaceFinder::PlaceFinder(std::string_view text) : text_(text) {
    constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
    if (text.starts_with(kByteOrderMark)) at_ = kByteOrderMark.size();
}

std::size_t PlaceFinder::find(TextPlace place) {
    while (place_ < place && at_ < text_.size()) {
        if (text_[at_++] == '\n') {
            place_ = {place_.line + 1, 1};
            continue;
        }
        while (at_ < text_.size() && continuesCodePoint(text_[at_])) ++at_;
        ++place_.column;
    }
    return place_ == place ? at_ : std::string_view::npos;
}

}  // namespace pfvox::scene
