// Bake options: the command line of probe-bake bake, and the settings that it stands for.
#pragma once

#include <optional>
#include <pfvox/bake.hpp>
#include <string>
#include <tl/expected.hpp>

#include "common/command_line.hpp"

namespace pfvox::tools {

struct BakeOptions {
    CommonOptions common;
    std::string input;
    std::string output;
    std::string profile = "faces";
    std::string resolution;
    std::optional<std::uint32_t> samples;
    std::optional<double> noise;
    std::optional<std::uint32_t> maxSamples;
    std::optional<std::uint32_t> bounces = BakeSettings{}.maxBounces;
    std::uint64_t seed = BakeSettings{}.seed;
    std::string probes;
    std::string device;
    std::uint64_t deviceMemoryMiB = 0;
    std::string depfile;
    std::string depfileKnown;
    bool listDevices = false;
    bool dryRun = false;
    bool resume = false;
    std::optional<bool> filter;  ///< nothing = as filtersByDefault() has it
    bool relocate = BakeSettings{}.relocate;
    bool force = false;
    bool explain = false;
    bool ifChanged = false;
    bool noSummary = false;
    bool warningsAsErrors = false;
};

void addBakeOptions(CLI::App& command, BakeOptions& options);

/// `--device`, as bake and verify have it.
void addDeviceOption(CLI::App& command, std::string& device);

/// Settings of a bake over so many probes. On failure: what is wrong with which option.
tl::expected<BakeSettings, std::string> settingsOf(const BakeOptions& options, std::uint64_t probeCount);

/// What is not given suits the device.
void adaptTo(const gpu::DeviceInfo& device, const BakeOptions& options, BakeSettings& settings);

/// "a:b", half open, within [0, probeCount]; or "k/n", part k of n from 0.
tl::expected<ProbeRange, std::string> parseProbeRange(const std::string& text, std::uint64_t probeCount);

/// "depth,light,irradiance,moments" in texels, 0 = none.
tl::expected<ProbeResolution, std::string> parseResolution(const std::string& text);

}  // namespace pfvox::tools
