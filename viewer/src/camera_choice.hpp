// CameraChoice: which camera a scene is first seen by.
#pragma once

#include <filesystem>
#include <optional>
#include <pfvox/scene.hpp>
#include <string>

#include "camera.hpp"

namespace pfvox::viewer {

struct CameraRequest {
    std::optional<ViewCamera> camera;  ///< a place; counts where no camera has the name
    std::string name;                  ///< of the scene or file; the text of a place, too, may be one
};

/// The camera that was asked for; a scene's first one when nothing was; nothing = frame everything. Errors:
/// BadReference (no camera of that name; the message lists those that are there).
Result<std::optional<ViewCamera>> chosenCamera(const CameraRequest& request,
                                               const std::filesystem::path& file, const Scene& scene);

}  // namespace pfvox::viewer
