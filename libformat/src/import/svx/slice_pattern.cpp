#include "import/svx/slice_pattern.hpp"

#include <fmt/format.h>

#include <charconv>

namespace pfvox::import::svx {

namespace {

constexpr std::size_t kMaxWidth = 32;

bool isDigit(char c) {
    return c >= '0' && c <= '9';
}

tl::unexpected<Error> badPattern(std::string_view text, std::string_view reason) {
    return fail(ErrorCode::BadValue,
                fmt::format("slices=\"{}\": {}; expected one number like \"slice%04d.png\"", text, reason));
}

}  // namespace

Result<SlicePattern> SlicePattern::parse(std::string_view text) {
    SlicePattern pattern;
    bool converted = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        std::string& literal = converted ? pattern.suffix_ : pattern.prefix_;
        if (text[i] != '%') {
            literal += text[i];
            continue;
        }
        if (++i == text.size()) return badPattern(text, "it ends in a lone %");
        if (text[i] == '%') {
            literal += '%';
            continue;
        }
        if (converted) return badPattern(text, "it has more than one conversion");
        if (text[i] == '0') pattern.padding_ = '0';
        for (; i < text.size() && isDigit(text[i]); ++i) {
            pattern.width_ = pattern.width_ * 10 + static_cast<std::size_t>(text[i] - '0');
            if (pattern.width_ > kMaxWidth) return badPattern(text, "its width is too large");
        }
        if (i == text.size() || (text[i] != 'd' && text[i] != 'i' && text[i] != 'u')) {
            return badPattern(text, "its conversion is not that of a whole number");
        }
        converted = true;
    }
    if (!converted) return badPattern(text, "it has no place for the slice number");
    return pattern;
}

std::string SlicePattern::nameOf(std::uint32_t slice) const {
    const std::string digits = std::to_string(slice);
    const std::string padding(width_ > digits.size() ? width_ - digits.size() : 0, padding_);
    return prefix_ + padding + digits + suffix_;
}

std::optional<std::uint32_t> SlicePattern::sliceOf(std::string_view name) const {
    if (name.size() <= prefix_.size() + suffix_.size()) return std::nullopt;
    if (!name.starts_with(prefix_) || !name.ends_with(suffix_)) return std::nullopt;
    name.remove_prefix(prefix_.size());
    name.remove_suffix(suffix_.size());
    const std::string_view digits = name.substr(std::min(name.find_first_not_of(' '), name.size()));
    std::uint32_t slice = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), slice);
    if (error != std::errc{} || end != digits.data() + digits.size()) return std::nullopt;
    return nameOf(slice) == prefix_ + std::string(name) + suffix_ ? std::optional{slice} : std::nullopt;
}

}  // namespace pfvox::import::svx
