// --limit name=value of every tool (declared in command_line.hpp).

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <limits>
#include <variant>

#include "common/command_line.hpp"
#include "common/text.hpp"

namespace pfvox::tools {

namespace {

struct LimitField {
    std::string_view name;
    std::variant<std::uint64_t Limits::*, std::uint32_t Limits::*> member;
};

constexpr std::array<LimitField, 8> kFields{{
    {"maxFileBytes", &Limits::maxFileBytes},
    {"maxMemoryBytes", &Limits::maxMemoryBytes},
    {"maxModels", &Limits::maxModels},
    {"maxInstances", &Limits::maxInstances},
    {"maxGraphDepth", &Limits::maxGraphDepth},
    {"maxMaterials", &Limits::maxMaterials},
    {"maxRegions", &Limits::maxRegions},
    {"maxModelDepth", &Limits::maxModelDepth},
}};

std::optional<std::uint64_t> parseCount(std::string_view text) {
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end == text.data()) return std::nullopt;
    const std::string_view suffix(end, static_cast<std::size_t>(text.data() + text.size() - end));
    int shift = 0;
    if (suffix == "K") shift = 10;
    if (suffix == "M") shift = 20;
    if (suffix == "G") shift = 30;
    if (shift == 0 && !suffix.empty()) return std::nullopt;
    if (value > std::numeric_limits<std::uint64_t>::max() >> shift) return std::nullopt;
    return value << shift;
}

/// Returns what is wrong, or nothing.
std::string assign(Limits& limits, const LimitField& field, std::uint64_t value) {
    if (const auto* wide = std::get_if<std::uint64_t Limits::*>(&field.member)) {
        limits.*(*wide) = value;
        return {};
    }
    if (value > std::numeric_limits<std::uint32_t>::max()) return fmt::format("{} is too large", value);
    limits.*std::get<std::uint32_t Limits::*>(field.member) = static_cast<std::uint32_t>(value);
    return {};
}

std::string unknownName(std::string_view name) {
    std::vector<std::string> names;
    for (const LimitField& field : kFields) names.emplace_back(field.name);
    if (const auto nearest = nearestWord(name, names))
        return fmt::format("no limit {}; did you mean {}?", name, *nearest);
    return fmt::format("no limit {}; there are {}", name, fmt::join(names, ", "));
}

}  // namespace

tl::expected<Limits, std::string> parseLimits(const std::vector<std::string>& assignments) {
    Limits limits;
    for (const std::string& word : assignments) {
        const auto complain = [&](const std::string& what) {
            return tl::make_unexpected(fmt::format("--limit {}: {}", word, what));
        };
        const std::size_t equals = word.find('=');
        if (equals == std::string::npos) return complain("write name=value");
        const std::string_view name = std::string_view(word).substr(0, equals);
        const auto* field = std::ranges::find(kFields, name, &LimitField::name);
        if (field == kFields.end()) return complain(unknownName(name));
        const auto value = parseCount(std::string_view(word).substr(equals + 1));
        if (!value) return complain("the value is a whole number, with K, M or G behind it if you like");
        if (std::string problem = assign(limits, *field, *value); !problem.empty()) return complain(problem);
    }
    return limits;
}

}  // namespace pfvox::tools
