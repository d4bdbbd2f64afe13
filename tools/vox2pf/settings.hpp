// Settings: what decides the content of an output, gathered from defaults, a TOML file, its overrides for
// single assets and the command line; the later ones win.
//
//     [import]
//     voxelSizeMetres = 0.05
//     [build]
//     lod = true
//     [encode]
//     zstdLevel = 9
//     [[override]]
//     files = "props/**"          # against the path below the input folder; without '/', against the file
//     name import.merge = true
#pragma once

#include <algorithm>
#include <filesystem>
#include <optional>
#include <pfvox/convert.hpp>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace pfvox::tools {

/// Settings that were given; the others are left as they are.
class SettingsPatch {
  public:
    /// `field` is the one of `values` that has this key in the table.
    template <class T>
    void give(std::string_view key, T& field, T value) {
        field = std::move(value);
        given_.insert(key);
    }
    void applyTo(ConvertSettings& settings) const;

    ConvertSettings values;

  private:
    std::set<std::string_view> given_;  ///< keys: no two sections have the same
};

inline constexpr int kArchiveZstdLevel = 9;

/// The value of that name, if there is one.
template <class Enum>
std::optional<Enum> choiceOf(const ConvertSetting& setting, std::string_view name) {
    const auto found = std::ranges::find(setting.choices, name);
    if (found == setting.choices.end()) return std::nullopt;
    return static_cast<Enum>(found - setting.choices.begin());
}

class SettingsFile {
  public:
    /// No file: every asset gets the defaults.
    SettingsFile() = default;

    /// Errors, each with file, line and column: FileNotFound, FileNotReadable, BadStructure (not TOML),
    /// BadValue (an unknown key, a wrong type or a value out of range).
    static Result<SettingsFile> load(const std::filesystem::path& file);

    /// The settings of one asset. `relative`: its path below the input folder, or its file name.
    ConvertSettings settingsFor(const std::filesystem::path& relative,
                                const SettingsPatch& commandLine) const;

    /// Patterns that fit none of these paths, though they would in other case (override-case).
    void reportNearMisses(const std::vector<std::filesystem::path>& relative, Diagnostics& diagnostics) const;

  private:
    struct Override {
        std::string files;
        SettingsPatch patch;
    };
    SettingsPatch base_;
    std::vector<Override> overrides_;

    friend class SettingsReader;
};

}  // namespace pfvox::tools
