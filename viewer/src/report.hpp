// What pfview says: devices and statistics.
#pragma once

#include <pfvox/error.hpp>
#include <pfvox/gpu.hpp>
#include <pfvox/gpu_scene.hpp>
#include <string>

#include "options.hpp"
#include "picture.hpp"

namespace pfvox::viewer {

std::string deviceTable(const std::vector<gpu::DeviceInfo>& devices);

/// One JSON object (docs/schema/view.schema.json).
struct RunReport {
    gpu::DeviceInfo device;
    gpu::MemoryUse memory = {};
    gpu::SceneStatistics scene;
    ViewCamera camera;
    PictureSettings settings;
    PictureStatistics picture = {};
    const ShownProbes* probes = nullptr;
    std::vector<PassTimes> frames = {};  ///< of each frame that was drawn
    double wallMs = 0.0;                 ///< from the first frame's start to the last one's end
    double loadMs = 0.0;
};
std::string toJson(const RunReport& report);

}  // namespace pfvox::viewer
