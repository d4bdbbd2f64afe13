#include "camera_choice.hpp"

#include <fmt/format.h>

namespace pfvox::viewer {

Result<std::optional<ViewCamera>> chosenCamera(const CameraRequest& request,
                                               const std::filesystem::path& file, const Scene& scene) {
    if (request.name.empty() && request.camera) return request.camera;
    if (request.name.empty()) {
        const bool isScene = file.extension() == ".toml";
        return isScene && !scene.cameras.empty() ? std::optional(viewCameraOf(scene.cameras.front()))
                                                 : std::nullopt;
    }
    std::string names;
    for (const Camera& camera : scene.cameras) {
        if (camera.name == request.name) return std::optional(viewCameraOf(camera));
        if (!camera.name.empty()) names += fmt::format("{}'{}'", names.empty() ? "" : ", ", camera.name);
    }
    if (request.camera) return request.camera;
    return tl::make_unexpected(
        Error{.code = ErrorCode::BadReference,
              .message = fmt::format(
                  "there is no camera '{}'; {}{}", request.name,
                  names.empty() ? "no camera has a name" : "there is " + names,
                  request.name.find(',') == std::string::npos ? "" : "; a place is px,py,pz,tx,ty,tz[,fovY]"),
              .file = file});
}

}  // namespace pfvox::viewer
