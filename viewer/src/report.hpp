// What pfview says: messages, exit codes and statistics.
#pragma once

#include <pfvox/error.hpp>
#include <pfvox/gpu.hpp>
#include <pfvox/gpu_scene.hpp>
#include <string>

#include "options.hpp"
#include "picture.hpp"

namespace pfvox::viewer {

/// Exit code of the tools for an error (docs/cli.md).
int exitCodeOf(ErrorCode code);

std::string deviceTable(const std::vector<gpu::DeviceInfo>& devices);

/// One JSON object: device, scene, camera, picture, memory.
struct RunReport {
    gpu::DeviceInfo device;
    gpu::MemoryUse memory = {};
    gpu::SceneStatistics scene;
    ViewCamera camera;
    PictureSettings settings;
    PictureStatistics picture = {};
    double loadMs = 0.0;
};
std::string toJson(const RunReport& report);

}  // namespace pfvox::viewer
