// The command line of pfview.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <variant>

#include "camera_choice.hpp"
#include "picture.hpp"

namespace pfvox::viewer {

struct Options {
    std::filesystem::path file;
    std::filesystem::path screenshot;
    PictureSettings picture;
    CameraRequest camera;
    ProbeRequest probes;
    std::optional<double> exposureStops;  ///< nothing = 0, in the window what it was last
    std::optional<ToneMap> toneMap;
    std::filesystem::path cameraPath;  ///< a flight instead of one picture; empty = none
    std::optional<bool> ground;        ///< nothing = under a single model; in the window what it was last
    std::uint32_t frames = 1;          ///< of which a picture is the mean; with cameraPath: pictures
    std::string device;                ///< gpu::DeviceOptions::selector
    std::string statisticsFile;        ///< "-" = stdout, empty = none
    bool sizeGiven = false;            ///< else the window has the size it had last
    bool listDevices = false;
    bool validation = false;
    bool quiet = false;

    /// Without a window: a picture, or figures alone.
    bool isHeadless() const { return !screenshot.empty() || !statisticsFile.empty(); }
};

/// What to print instead of working: help and version go to stdout with exit code 0, faults to stderr with 2.
struct EarlyExit {
    int exitCode = 0;
    std::string text;
};

std::variant<Options, EarlyExit> parseOptions(int argc, const char* const* argv);

}  // namespace pfvox::viewer
