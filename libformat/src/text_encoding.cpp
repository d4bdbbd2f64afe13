#include <array>
#include <cstdint>
#include <pfvox/text_encoding.hpp>

namespace pfvox {

namespace {

/// 0x80 to 0x9f; the other bytes are the code points of their values.
constexpr std::array<char16_t, 32> kWindows1252{
    0x20ac, 0xfffd, 0x201a, 0x0192, 0x201e, 0x2026, 0x2020, 0x2021, 0x02c6, 0x2030, 0x0160,
    0x2039, 0x0152, 0xfffd, 0x017d, 0xfffd, 0xfffd, 0x2018, 0x2019, 0x201c, 0x201d, 0x2022,
    0x2013, 0x2014, 0x02dc, 0x2122, 0x0161, 0x203a, 0x0153, 0xfffd, 0x017e, 0x0178};

std::uint32_t byteAt(std::string_view text, std::size_t i) {
    return static_cast<unsigned char>(text[i]);
}

/// Bytes that a lead byte announces; 0 for bytes that lead nothing.
std::size_t announcedBytes(std::uint32_t lead) {
    if (lead < 0x80) return 1;
    if (lead >= 0xc2 && lead < 0xe0) return 2;
    if (lead >= 0xe0 && lead < 0xf0) return 3;
    return lead >= 0xf0 && lead < 0xf5 ? 4 : 0;
}

}  // namespace

CodePoint firstCodePoint(std::string_view text) {
    if (text.empty()) return {};
    const std::uint32_t lead = byteAt(text, 0);
    const std::size_t bytes = announcedBytes(lead);
    if (bytes == 0 || bytes > text.size()) return {};
    constexpr std::array<std::uint32_t, 5> kLeadBits{0, 0x7f, 0x1f, 0x0f, 0x07};
    std::uint32_t value = lead & kLeadBits[bytes];
    for (std::size_t i = 1; i < bytes; ++i) {
        const std::uint32_t next = byteAt(text, i);
        if ((next & 0xc0u) != 0x80u) return {};
        value = value << 6 | (next & 0x3fu);
    }
    constexpr std::array<std::uint32_t, 5> kLeast{0, 0, 0x80, 0x800, 0x10000};
    const bool isSurrogate = value >= 0xd800 && value < 0xe000;
    if (value < kLeast[bytes] || value > 0x10ffff || isSurrogate) return {};
    return {.value = value, .bytes = bytes};
}

bool isUtf8(std::string_view text) {
    while (!text.empty()) {
        const CodePoint next = firstCodePoint(text);
        if (next.bytes == 0) return false;
        text.remove_prefix(next.bytes);
    }
    return true;
}

std::string utf8Of(char32_t codePoint) {
    const auto c = static_cast<std::uint32_t>(codePoint);
    const auto tail = [&](int shift) { return static_cast<char>(0x80u | (c >> shift & 0x3fu)); };
    if (c < 0x80) return {static_cast<char>(c)};
    if (c < 0x800) return {static_cast<char>(0xc0u | c >> 6), tail(0)};
    if (c < 0x10000) return {static_cast<char>(0xe0u | c >> 12), tail(6), tail(0)};
    return {static_cast<char>(0xf0u | c >> 18), tail(12), tail(6), tail(0)};
}

std::string utf8FromWindows1252(std::string_view bytes) {
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        const std::uint32_t byte = byteAt(bytes, i);
        text += utf8Of(byte >= 0x80 && byte < 0xa0 ? kWindows1252[byte - 0x80] : static_cast<char32_t>(byte));
    }
    return text;
}

}  // namespace pfvox
