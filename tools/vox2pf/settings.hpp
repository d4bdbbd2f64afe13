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

#include <filesystem>
#include <optional>
#include <pfvox/convert.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace pfvox::tools {

/// Settings that were given; the others are left as they are.
struct SettingsPatch {
    std::optional<bool> merge;
    std::optional<bool> includeHidden;
    std::optional<int> frame;
    std::optional<double> voxelSizeMetres;
    std::optional<double> svxThreshold;
    std::optional<std::vector<std::string>> vdbGrids;
    std::optional<double> vdbThreshold;
    std::optional<UpAxis> vdbUpAxis;
    std::optional<bool> hollow;
    std::optional<bool> lod;
    std::optional<int> zstdLevel;
    std::optional<Profile> profile;

    void applyTo(ConvertSettings& settings) const;
};

/// What the fields may hold; the command line and the file share it.
inline constexpr int kMaxFrame = 1'000'000;
inline constexpr double kMinVoxelSizeMetres = 1e-6;
inline constexpr double kMaxVoxelSizeMetres = 1e6;
inline constexpr double kMaxVdbThreshold = 1e30;
inline constexpr int kMaxZstdLevel = 19;
inline constexpr int kArchiveZstdLevel = 9;

/// "packed" or "resident".
std::optional<Profile> parseProfile(std::string_view name);

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
