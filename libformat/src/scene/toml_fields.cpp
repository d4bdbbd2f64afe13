#include "scene/toml_fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pfvox::scene {

namespace {

bool within(double value, Range range) {
    return std::isfinite(value) && value >= range.low && value <= range.high;
}

void inOrderOfText(auto& complaints) {
    std::ranges::stable_sort(complaints, [](const auto& a, const auto& b) {
        return std::pair(a.place.begin.line, a.place.begin.column) <
               std::pair(b.place.begin.line, b.place.begin.column);
    });
}

}  // namespace

std::string placeText(const toml::source_region& place) {
    return fmt::format("line {}, column {}", place.begin.line, place.begin.column);
}

void TomlFields::readTable(const toml::table& table, std::string_view title, const Known& known) {
    for (const auto& [key, node] : table) {
        const std::string_view word = key.str();  // clang 14 captures no structured binding
        const auto reader =
            std::ranges::find_if(known, [&](const auto& entry) { return entry.first == word; });
        if (reader != known.end()) {
            reader->second(node);
            continue;
        }
        std::string names;
        for (const auto& [name, read] : known) names += fmt::format("{}{}", names.empty() ? "" : ", ", name);
        warn(key.source(), "scene-unknown-key",
             fmt::format("unknown key {}; {} has {}", key.str(), title, names));
    }
}

std::optional<double> TomlFields::asNumber(const toml::node& node) {
    return node.is_number() ? node.value<double>() : std::nullopt;
}

std::optional<double> TomlFields::numberIn(std::string_view key, const toml::node& node, Range range) {
    const std::optional<double> value = asNumber(node);
    if (value && within(*value, range)) return value;
    error(node.source(), fmt::format("{} is a number from {} to {}", key, range.low, range.high));
    return std::nullopt;
}

std::optional<glm::dvec3> TomlFields::vectorIn(std::string_view key, const toml::node& node, Range range) {
    const toml::array* const array = node.as_array();
    if (array == nullptr || array->size() != 3) {
        error(node.source(), fmt::format("{} is a list of 3 numbers", key));
        return std::nullopt;
    }
    glm::dvec3 vector{0.0};
    for (int axis = 0; axis < 3; ++axis) {
        const toml::node& element = *array->get(static_cast<std::size_t>(axis));
        const std::optional<double> value = asNumber(element);
        if (!value || !within(*value, range)) {
            error(element.source(),
                  fmt::format("{} is a list of 3 numbers from {} to {}", key, range.low, range.high));
            return std::nullopt;
        }
        vector[axis] = *value;
    }
    return vector;
}

TomlFields::Read TomlFields::number(std::string_view key, double& field, Range range) {
    return [=, this, &field](const toml::node& node) { field = numberIn(key, node, range).value_or(field); };
}

TomlFields::Read TomlFields::number(std::string_view key, std::optional<double>& field, Range range) {
    return [=, this, &field](const toml::node& node) { field = numberIn(key, node, range); };
}

TomlFields::Read TomlFields::vector(std::string_view key, glm::dvec3& field, Range range) {
    return [=, this, &field](const toml::node& node) { field = vectorIn(key, node, range).value_or(field); };
}

TomlFields::Read TomlFields::vector(std::string_view key, std::optional<glm::dvec3>& field, Range range) {
    return [=, this, &field](const toml::node& node) { field = vectorIn(key, node, range); };
}

TomlFields::Read TomlFields::counts(std::string_view key, glm::uvec3& field, std::uint32_t high) {
    return [=, this, &field](const toml::node& node) {
        const toml::array* const array = node.as_array();
        const bool whole = array != nullptr && array->size() == 3 &&
                           std::ranges::all_of(*array, [](const toml::node& e) { return e.is_integer(); });
        const std::optional<glm::dvec3> vector =
            whole ? vectorIn(key, node, {1.0, static_cast<double>(high)}) : std::nullopt;
        if (vector) field = glm::uvec3(*vector);
        if (!whole)
            error(node.source(), fmt::format("{} is a list of 3 whole numbers from 1 to {}", key, high));
    };
}

TomlFields::Read TomlFields::text(std::string_view key, std::string& field) {
    return [=, this, &field](const toml::node& node) {
        const std::optional<std::string> value = node.value_exact<std::string>();
        if (value && value->find('\0') == std::string::npos) {
            field = *value;
        } else {
            error(node.source(), fmt::format("{} is a text in quotes, without NUL", key));
        }
    };
}

TomlFields::Read TomlFields::flag(std::string_view key, bool& field) {
    return [=, this, &field](const toml::node& node) {
        const std::optional<bool> value = node.value_exact<bool>();
        field = value.value_or(field);
        if (!value) error(node.source(), fmt::format("{} is true or false", key));
    };
}

void TomlFields::error(const toml::source_region& place, std::string message, ErrorCode code) {
    errors_.push_back({.place = place, .code = code, .id = {}, .message = std::move(message)});
}

void TomlFields::warn(const toml::source_region& place, std::string id, std::string message) {
    warnings_.push_back({.place = place, .id = std::move(id), .message = std::move(message)});
}

Result<void> TomlFields::finish(const std::filesystem::path& file, Diagnostics& diagnostics) {
    constexpr std::size_t kShown = 10;
    constexpr std::size_t kShownWarnings = 100;
    inOrderOfText(warnings_);
    inOrderOfText(errors_);
    for (std::size_t i = 0; i < std::min(warnings_.size(), kShownWarnings); ++i) {
        const Complaint& warning = warnings_[i];
        diagnostics.warn(warning.id, fmt::format("{}: {}", placeText(warning.place), warning.message));
    }
    if (warnings_.size() > kShownWarnings) {
        diagnostics.warn("scene-more-warnings",
                         fmt::format("and {} more warnings", warnings_.size() - kShownWarnings));
    }
    if (errors_.empty()) return {};
    std::string message = errors_.front().message;
    for (std::size_t i = 1; i < std::min(errors_.size(), kShown); ++i) {
        message += fmt::format("\n  {}: {}", placeText(errors_[i].place), errors_[i].message);
    }
    if (errors_.size() > kShown) message += fmt::format("\n  and {} more", errors_.size() - kShown);
    return tl::make_unexpected(Error{.code = errors_.front().code,
                                     .message = std::move(message),
                                     .file = file,
                                     .context = placeText(errors_.front().place)});
}

}  // namespace pfvox::scene
