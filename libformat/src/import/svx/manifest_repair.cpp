#include "import/svx/manifest_repair.hpp"

#include <algorithm>
#include <array>
#include <pfvox/text_encoding.hpp>

namespace pfvox::import::svx {

namespace {

constexpr std::array<std::string_view, 2> kLeaves{"entry", "channel"};

/// The end of the tag that begins at `start`: its '>', outside of quotes. npos where there is none.
std::size_t tagEnd(std::string_view xml, std::size_t start) {
    char quote = '\0';
    for (std::size_t i = start; i < xml.size(); ++i) {
        const char c = xml[i];
        if (quote != '\0') {
            if (c == quote) quote = '\0';
        } else if (c == '"' || c == '\'') {
            quote = c;
        } else if (c == '>') {
            return i;
        }
    }
    return std::string_view::npos;
}

std::string withStraightQuotes(std::string_view utf8) {
    std::string text;
    while (!utf8.empty()) {
        const CodePoint next = firstCodePoint(utf8);
        const bool isDouble = next.value == 0x201c || next.value == 0x201d;
        text += isDouble ? std::string_view("\"") : utf8.substr(0, next.bytes);
        utf8.remove_prefix(next.bytes);
    }
    return text;
}

bool isLeftOpen(std::string_view xml, std::string_view tag, std::size_t behindTag) {
    const std::string_view name = tag.substr(0, std::min(tag.find_first_of(" \t\r\n"), tag.size()));
    if (tag.ends_with('/') || std::ranges::find(kLeaves, name) == kLeaves.end()) return false;
    const std::size_t next = xml.find('<', behindTag);
    return next == std::string_view::npos || !xml.substr(next).starts_with("</" + std::string(name));
}

}  // namespace

std::string repairedManifest(std::string_view xml) {
    const std::string straight =
        withStraightQuotes(isUtf8(xml) ? std::string(xml) : utf8FromWindows1252(xml));
    const std::string_view text = straight;
    std::string repaired;
    std::size_t at = 0;
    while (at < text.size()) {
        const std::size_t start = std::min(text.find('<', at), text.size());
        repaired += text.substr(at, start - at);
        const std::size_t end = start < text.size() ? tagEnd(text, start + 1) : std::string_view::npos;
        if (end == std::string_view::npos) {
            repaired += text.substr(start);
            break;
        }
        repaired += text.substr(start, end - start);
        if (isLeftOpen(text, text.substr(start + 1, end - start - 1), end + 1)) repaired += '/';
        repaired += '>';
        at = end + 1;
    }
    return repaired;
}

}  // namespace pfvox::import::svx
