// What the viewer's programs on the device are given, from cameras and settings.
#pragma once

#include "picture.hpp"
#include "shared/view.glsl.h"

namespace pfvox::viewer {

shared::ViewParameters viewParametersOf(const ViewCamera& camera, const PictureSettings& settings);
PictureStatistics statisticsOf(const shared::ViewCounters& counters, double gpuMs);
/// Workgroups that cover the picture.
glm::uvec3 groupsOf(const PictureSettings& settings);

}  // namespace pfvox::viewer
