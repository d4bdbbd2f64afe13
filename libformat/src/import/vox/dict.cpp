#include "import/vox/dict.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace pfvox::import::vox {

namespace {

constexpr std::string_view kBlanks = " \t\r\n";

std::string_view skipBlanks(std::string_view text) {
    const std::size_t first = text.find_first_not_of(kBlanks);
    return first == std::string_view::npos ? std::string_view{} : text.substr(first);
}

/// Reads one number from the front of `text` and cuts it off, with the blanks around it.
template <class Number>
std::optional<Number> takeNumber(std::string_view& text) {
    text = skipBlanks(text);
    if (text.starts_with('+')) text.remove_prefix(1);
    Number value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{}) return std::nullopt;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    if (!text.empty() && kBlanks.find(text.front()) == std::string_view::npos) return std::nullopt;
    text = skipBlanks(text);
    return value;
}

template <class Number, std::size_t N>
std::optional<std::array<Number, N>> parseExactly(std::string_view text) {
    std::array<Number, N> values;
    for (Number& value : values) {
        const std::optional<Number> next = takeNumber<Number>(text);
        if (!next) return std::nullopt;
        value = *next;
    }
    if (!text.empty()) return std::nullopt;
    return values;
}

template <std::size_t N>
std::optional<std::array<float, N>> parseFinite(std::string_view text) {
    const auto values = parseExactly<float, N>(text);
    if (!values || !std::ranges::all_of(*values, [](float v) { return std::isfinite(v); }))
        return std::nullopt;
    return values;
}

}  // namespace

std::optional<std::string_view> Dict::find(std::string_view key) const {
    // From the back: of several entries with one key the last one counts.
    const auto found = std::find_if(entries_.rbegin(), entries_.rend(),
                                    [&](const auto& entry) { return entry.first == key; });
    return found == entries_.rend() ? std::nullopt : std::optional(found->second);
}

bool Dict::flag(std::string_view key) const {
    const std::optional<std::string_view> value = find(key);
    return value && parseInt(*value).value_or(0) != 0;
}

std::optional<std::int32_t> parseInt(std::string_view text) {
    const auto values = parseExactly<std::int32_t, 1>(text);
    return values ? std::optional{values->front()} : std::nullopt;
}

std::optional<float> parseFloat(std::string_view text) {
    const auto values = parseFinite<1>(text);
    return values ? std::optional{values->front()} : std::nullopt;
}

std::optional<std::array<std::int32_t, 3>> parseInt3(std::string_view text) {
    return parseExactly<std::int32_t, 3>(text);
}

std::optional<std::array<float, 3>> parseFloat3(std::string_view text) {
    return parseFinite<3>(text);
}

}  // namespace pfvox::import::vox
