// Settings: what the viewer remembers from run to run, as TOML in the user's folders (XDG base directories).
//
//     $XDG_CONFIG_HOME/pfvox/pfview.toml          preferences; for people to edit
//     $XDG_STATE_HOME/pfvox/pfview-cameras.toml   where the camera stood in each file
#pragma once

#include <filesystem>
#include <map>
#include <pfvox/error.hpp>
#include <string>
#include <string_view>

#include "camera_controller.hpp"
#include "view_modes.hpp"

namespace pfvox::viewer {

struct Settings {
    std::uint32_t windowWidth = 1280;
    std::uint32_t windowHeight = 720;
    CameraMode cameraMode = CameraMode::Orbit;
    bool showWindows = true;
    bool antiAliasing = true;    ///< temporal: frames become one picture
    double renderScale = 1.0;    ///< pixels computed for each pixel of the window, along an edge: 0.25 to 1
    double lodPixels = 1.0;      ///< PictureSettings::lodPixels, 0 to 16
    double exposureStops = 0.0;  ///< -16 to 16
    ToneMap toneMap = ToneMap::Standard;
    bool modelGround = true;     ///< a ground under a single model
    bool sceneGround = false;    ///< and under scenes
    bool showProbeGrid = false;  ///< upon the picture
    bool showBounds = false;     ///< boxes of the models, upon the picture
    bool operator==(const Settings&) const = default;
};

/// Unknown keys are ignored; what is out of range or of the wrong type becomes its default, with the
/// diagnostic "settings-bad-value". Errors: BadStructure (not TOML).
Result<Settings> parseSettings(std::string_view text, Diagnostics& diagnostics);
std::string settingsText(const Settings& settings);

/// By absolute path of the scene or file.
using CameraMemory = std::map<std::string, ViewCamera>;
inline constexpr std::size_t kMaxRememberedCameras = 200;

/// Entries that are no camera are left out. Errors: BadStructure (not TOML).
Result<CameraMemory> parseCameras(std::string_view text);
std::string camerasText(const CameraMemory& cameras);

struct UserFolders {
    std::filesystem::path config;
    std::filesystem::path state;
};
/// From the values of XDG_CONFIG_HOME, XDG_STATE_HOME and HOME; null = not set. Relative ones count as not
/// set, as the XDG specification says. Both are empty when there is no home: nothing is remembered then.
UserFolders userFolders(const char* configHome, const char* stateHome, const char* home);

/// Both files; what is not there or cannot be read has defaults, the latter with a diagnostic.
struct Memory {
    Settings settings;
    CameraMemory cameras;
};
Memory loadMemory(const UserFolders& folders, Diagnostics& diagnostics);
/// Errors: FileNotWritable.
Result<void> saveMemory(const UserFolders& folders, const Memory& memory);

}  // namespace pfvox::viewer
