#include "vox2pf/settings.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>
#include <pfvox/files.hpp>

#include <algorithm>
#include <array>

#include "common/text.hpp"
#include "scene/toml_nesting.hpp"

namespace pfvox::tools {

namespace {

constexpr std::uint64_t kMaxSettingsBytes = 1 << 20;
constexpr std::size_t kMaxPatternBytes = 4096;

}  // namespace

void SettingsPatch::applyTo(ConvertSettings& settings) const {
    forEachConvertSetting(
        [&](const ConvertSetting& setting, auto& to, const auto& from) {
            if (given_.contains(setting.key)) to = from;
        },
        settings, values);
}

ConvertSettings SettingsFile::settingsFor(const std::filesystem::path& relative,
                                          const SettingsPatch& commandLine) const {
    ConvertSettings settings;
    base_.applyTo(settings);
    for (const Override& entry : overrides_) {
        if (globMatches(entry.files, relative.generic_string())) entry.patch.applyTo(settings);
    }
    commandLine.applyTo(settings);
    return settings;
}

void SettingsFile::reportNearMisses(const std::vector<std::filesystem::path>& relative,
                                    Diagnostics& diagnostics) const {
    for (const Override& entry : overrides_) {
        const auto fits = [&](const std::filesystem::path& path) {
            return globMatches(entry.files, path.generic_string());
        };
        const auto nearlyFits = [&](const std::filesystem::path& path) {
            return globMatches(lowerCase(entry.files), lowerCase(path.generic_string()));
        };
        if (std::ranges::any_of(relative, fits)) continue;
        const auto meant = std::ranges::find_if(relative, nearlyFits);
        if (meant == relative.end()) continue;
        diagnostics.warn(
            "override-case",
            fmt::format("the pattern \"{}\" of an [[override]] fits no input, but would fit {} in "
                        "other case: upper and lower case are different letters in paths",
                        entry.files, meant->generic_string()));
    }
}

/// Turns a TOML document into a SettingsFile; every complaint has its line and column.
class SettingsReader {
  public:
    explicit SettingsReader(const std::filesystem::path& file) : file_(file) {}

    Result<SettingsFile> read(const toml::table& document) {
        SettingsFile settings;
        for (const auto& [key, node] : document) {
            if (key == "override") {
                PFVOX_CHECK(readOverrides(node, settings));
            } else {
                PFVOX_CHECK(readSection(key, node, settings.base_, {"override"}));
            }
        }
        return settings;
    }

    tl::unexpected<Error> failAtRegion(ErrorCode code, const toml::source_region& place,
                                       std::string message) const {
        return tl::make_unexpected(
            Error{.code = code,
                  .message = std::move(message),
                  .file = file_,
                  .context = fmt::format("line {}, column {}", place.begin.line, place.begin.column)});
    }

  private:
    using Names = std::vector<std::string>;

    tl::unexpected<Error> unknown(const toml::key& key, std::string_view kind, const Names& known) const {
        const auto nearest = nearestWord(key.str(), known);
        const std::string hint = nearest ? fmt::format("; did you mean {}?", *nearest)
                                         : fmt::format("; there are {}", fmt::join(known, ", "));
        return failAtRegion(ErrorCode::BadValue, key.source(),
                            fmt::format("unknown {} {}{}", kind, key.str(), hint));
    }

    Result<void> readOverrides(const toml::node& node, SettingsFile& settings) {
        const toml::array* entries = node.as_array();
        if (entries == nullptr || !entries->is_homogeneous(toml::node_type::table)) {
            return failAtRegion(ErrorCode::BadValue, node.source(), "write overrides as [[override]] tables");
        }
        for (const toml::node& entry : *entries) PFVOX_CHECK(readOverride(*entry.as_table(), settings));
        return {};
    }

    Result<void> readOverride(const toml::table& table, SettingsFile& settings) {
        SettingsFile::Override entry;
        for (const auto& [key, node] : table) {
            if (key == "files") {
                PFVOX_TRY(std::string, pattern, patternOf(node));
                entry.files = std::move(pattern);
            } else {
                PFVOX_CHECK(readSection(key, node, entry.patch, {"files"}));
            }
        }
        if (entry.files.empty()) {
            return failAtRegion(ErrorCode::BadValue, table.source(),
                                "an [[override]] needs files = \"<pattern>\"");
        }
        settings.overrides_.push_back(std::move(entry));
        return {};
    }

    /// With '/' between folders, however they were written.
    Result<std::string> patternOf(const toml::node& node) const {
        std::string pattern = node.value_or(std::string());
        if (pattern.empty())
            return failAtRegion(ErrorCode::BadValue, node.source(),
                                "files is a pattern, such as \"props/**\"");
        if (pattern.size() > kMaxPatternBytes) {
            return failAtRegion(ErrorCode::BadValue, node.source(),
                                fmt::format("a pattern of {} bytes is longer than any path", pattern.size()));
        }
        if (const auto path = io::pathFromText(pattern); !path)
            return failAtRegion(ErrorCode::BadValue, node.source(), path.error().message);
        std::ranges::replace(pattern, '\\', '/');
        return pattern;
    }

    /// One of the sections that the table of settings has. `others`: further names that could have been
    /// meant.
    Result<void> readSection(const toml::key& name, const toml::node& node, SettingsPatch& patch,
                             Names others) {
        Names keys;
        forEachConvertSetting(
            [&](const ConvertSetting& setting, const auto&) {
                if (setting.section == name.str()) keys.emplace_back(setting.key);
                if (std::ranges::find(others, setting.section) == others.end())
                    others.emplace_back(setting.section);
            },
            patch.values);
        if (keys.empty()) return unknown(name, "section", others);
        const toml::table* table = node.as_table();
        if (table == nullptr) {
            return failAtRegion(ErrorCode::BadValue, node.source(),
                                fmt::format("{} is a section", name.str()));
        }
        for (const auto& entry : *table) {
            // Not [key, value]: clang before 16 cannot capture those.
            const toml::key& key = entry.first;
            const toml::node& value = entry.second;
            if (std::ranges::find(keys, key.str()) == keys.end()) return unknown(key, "key", keys);
            Result<void> read;
            forEachConvertSetting(
                [&](const ConvertSetting& setting, auto& field) {
                    if (setting.key != key.str()) return;
                    auto given = valueOf(setting, field, value);
                    if (given) {
                        patch.give(setting.key, field, std::decay_t<decltype(field)>(*std::move(given)));
                    } else {
                        read = failAtRegion(ErrorCode::BadValue, value.source(),
                                            fmt::format("{} is {}", setting.key, given.error()));
                    }
                },
                patch.values);
            PFVOX_CHECK(read);
        }
        return {};
    }

    // What a node says for a field of this type, or what it should have been.

    template <class T>
    using Given = tl::expected<T, std::string>;

    static Given<bool> valueOf(const ConvertSetting&, bool, const toml::node& node) {
        const std::optional<bool> value = node.value_exact<bool>();
        return value ? Given<bool>(*value) : tl::make_unexpected("true or false");
    }
    template <class T>
    requires std::is_arithmetic_v<T>
    static Given<T> valueOf(const ConvertSetting& setting, T, const toml::node& node) {
        const std::optional<T> value = node.is_number() ? node.value<T>() : std::nullopt;
        if (value && static_cast<double>(*value) >= setting.low &&
            static_cast<double>(*value) <= setting.high)
            return *value;
        return tl::make_unexpected(fmt::format(
            "a {}number from {} to {}", std::is_integral_v<T> ? "whole " : "", setting.low, setting.high));
    }
    static Given<double> valueOf(const ConvertSetting& setting, const std::optional<double>&,
                                 const toml::node& node) {
        return valueOf(setting, 0.0, node);
    }
    static Given<Names> valueOf(const ConvertSetting&, const Names&, const toml::node& node) {
        const toml::array* names = node.as_array();
        if (names == nullptr || !names->is_homogeneous(toml::node_type::string))
            return tl::make_unexpected("a list of names");
        Names given;
        for (const toml::node& name : *names) given.push_back(name.value_or(std::string()));
        return given;
    }
    template <class Enum>
    requires std::is_enum_v<Enum>
    static Given<Enum> valueOf(const ConvertSetting& setting, Enum, const toml::node& node) {
        const auto value = choiceOf<Enum>(setting, node.value_or(std::string_view()));
        if (value) return *value;
        return tl::make_unexpected(fmt::format("\"{}\"", fmt::join(setting.choices, "\" or \"")));
    }

    const std::filesystem::path& file_;
};

Result<SettingsFile> SettingsFile::load(const std::filesystem::path& file) {
    PFVOX_TRY(const io::FileBytes, contents, io::readFile(file, kMaxSettingsBytes));
    const auto bytes = contents.bytes();
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    SettingsReader reader(file);
    if (const auto place = scene::tooDeepAt(text)) {
        return reader.failAtRegion(ErrorCode::BadStructure, {.begin = {place->line, place->column}},
                                   fmt::format("nested deeper than {}", scene::kMaxNesting));
    }
    try {
        const toml::table document = toml::parse(text);
        return reader.read(document);
    } catch (const toml::parse_error& error) {
        return reader.failAtRegion(ErrorCode::BadStructure, error.source(), std::string(error.description()));
    }
}

}  // namespace pfvox::tools
