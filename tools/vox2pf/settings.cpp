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

template <class T>
void assignIfSet(T& field, const auto& given) {
    if (given) field = *given;
}

}  // namespace

void SettingsPatch::applyTo(ConvertSettings& settings) const {
    assignIfSet(settings.import.merge, merge);
    assignIfSet(settings.import.includeHidden, includeHidden);
    assignIfSet(settings.import.frame, frame);
    assignIfSet(settings.import.voxelSizeMetres, voxelSizeMetres);
    assignIfSet(settings.import.svx.threshold, svxThreshold);
    assignIfSet(settings.import.vdb.grids, vdbGrids);
    assignIfSet(settings.import.vdb.threshold, vdbThreshold);
    assignIfSet(settings.import.vdb.upAxis, vdbUpAxis);
    assignIfSet(settings.hollow, hollow);
    assignIfSet(settings.build.lod, lod);
    assignIfSet(settings.zstdLevel, zstdLevel);
    assignIfSet(settings.profile, profile);
}

std::optional<Profile> parseProfile(std::string_view name) {
    if (name == "packed") return Profile::Packed;
    if (name == "resident") return Profile::Resident;
    return std::nullopt;
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

    /// One of [import], [build], [encode]. `others`: further names that could have been meant.
    Result<void> readSection(const toml::key& name, const toml::node& node, SettingsPatch& patch,
                             Names others) {
        if (name != "import" && name != "build" && name != "encode") {
            others.insert(others.end(), {"import", "build", "encode"});
            return unknown(name, "section", others);
        }
        const toml::table* table = node.as_table();
        if (table == nullptr) {
            return failAtRegion(ErrorCode::BadValue, node.source(),
                                fmt::format("{} is a section", name.str()));
        }
        for (const auto& [key, value] : *table) {
            PFVOX_CHECK(name == "import"  ? readImportKey(key, value, patch)
                        : name == "build" ? readBuildKey(key, value, patch)
                                          : readEncodeKey(key, value, patch));
        }
        return {};
    }

    Result<void> readImportKey(const toml::key& key, const toml::node& value, SettingsPatch& patch) {
        if (key == "merge") return readFlag(key, value, patch.merge);
        if (key == "includeHidden") return readFlag(key, value, patch.includeHidden);
        if (key == "frame") return readNumber(key, value, patch.frame, 0, kMaxFrame);
        if (key == "voxelSizeMetres") {
            return readNumber(key, value, patch.voxelSizeMetres, kMinVoxelSizeMetres, kMaxVoxelSizeMetres);
        }
        if (key == "svxThreshold") return readNumber(key, value, patch.svxThreshold, 0.0, 1.0);
        if (key == "vdbThreshold") {
            return readNumber(key, value, patch.vdbThreshold, -kMaxVdbThreshold, kMaxVdbThreshold);
        }
        if (key == "vdbGrids") return readNames(key, value, patch.vdbGrids);
        if (key == "vdbUp") return readUpAxis(key, value, patch.vdbUpAxis);
        return unknown(key, "key",
                       {"merge", "includeHidden", "frame", "voxelSizeMetres", "svxThreshold", "vdbGrids",
                        "vdbThreshold", "vdbUp"});
    }

    Result<void> readNames(const toml::key& key, const toml::node& node,
                           std::optional<std::vector<std::string>>& field) {
        const toml::array* names = node.as_array();
        if (names == nullptr || !names->is_homogeneous(toml::node_type::string)) {
            return failAtRegion(ErrorCode::BadValue, node.source(),
                                fmt::format("{} is a list of names", key.str()));
        }
        field.emplace();
        for (const toml::node& name : *names) field->push_back(name.value_or(std::string()));
        return {};
    }

    Result<void> readUpAxis(const toml::key& key, const toml::node& node, std::optional<UpAxis>& field) {
        const std::string axis = node.value_or(std::string());
        if (axis != "y" && axis != "z") {
            return failAtRegion(ErrorCode::BadValue, node.source(),
                                fmt::format("{} is \"y\" or \"z\"", key.str()));
        }
        field = axis == "z" ? UpAxis::Z : UpAxis::Y;
        return {};
    }

    Result<void> readBuildKey(const toml::key& key, const toml::node& value, SettingsPatch& patch) {
        if (key == "hollow") return readFlag(key, value, patch.hollow);
        if (key == "lod") return readFlag(key, value, patch.lod);
        return unknown(key, "key", {"hollow", "lod"});
    }

    Result<void> readEncodeKey(const toml::key& key, const toml::node& value, SettingsPatch& patch) {
        if (key == "zstdLevel") return readNumber(key, value, patch.zstdLevel, 1, kMaxZstdLevel);
        if (key == "profile") return readProfile(key, value, patch.profile);
        return unknown(key, "key", {"zstdLevel", "profile"});
    }

    Result<void> readProfile(const toml::key& key, const toml::node& node, std::optional<Profile>& field) {
        field = parseProfile(node.value_or(std::string_view()));
        if (field) return {};
        return failAtRegion(ErrorCode::BadValue, node.source(),
                            fmt::format("{} is \"packed\" or \"resident\"", key.str()));
    }

    Result<void> readFlag(const toml::key& key, const toml::node& node, std::optional<bool>& field) {
        field = node.value_exact<bool>();
        if (field) return {};
        return failAtRegion(ErrorCode::BadValue, node.source(),
                            fmt::format("{} is true or false", key.str()));
    }

    template <class T>
    Result<void> readNumber(const toml::key& key, const toml::node& node, std::optional<T>& field, T low,
                            T high) {
        const std::optional<T> value = node.is_number() ? node.value<T>() : std::nullopt;
        if (!value || !(*value >= low && *value <= high)) {
            return failAtRegion(ErrorCode::BadValue, node.source(),
                                fmt::format("{} is a {}number from {} to {}", key.str(),
                                            std::is_integral_v<T> ? "whole " : "", low, high));
        }
        field = value;
        return {};
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
