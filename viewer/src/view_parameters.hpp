// What the viewer's programs on the device are given, from cameras and settings, and what they count.
#pragma once

#include <array>

#include "picture.hpp"
#include "shared/view.glsl.h"

namespace pfvox::viewer {

shared::ViewParameters viewParametersOf(const ViewCamera& camera, const PictureSettings& settings,
                                        const PictureInput& input);

using ViewCounts = std::array<glm::uvec2, shared::kViewCounterCount>;
/// All but times.
PictureStatistics statisticsOf(const ViewCounts& counts, std::uint64_t cameraRays);

}  // namespace pfvox::viewer
