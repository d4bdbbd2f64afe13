// CameraPath: a flight through a scene: cameras in a JSON file, smoothly joined.
//
//     {"cameras": [{"position": [4, 3, 8], "target": [0, 1, 0], "fovYDegrees": 50}, ...]}
#pragma once

#include <pfvox/error.hpp>
#include <string_view>
#include <vector>

#include "camera.hpp"

namespace pfvox::viewer {

class CameraPath {
  public:
    /// `fovYDegrees` may be left out: 40. Errors: BadStructure (not JSON, no cameras), BadValue (not three
    /// finite numbers, position and target the same, a field of view not within 1 to 170).
    static Result<CameraPath> parse(std::string_view text);

    /// 0 = the first camera, 1 = the last; each pair of neighbors takes the same time. Through all cameras,
    /// without corners (Catmull-Rom splines of position and target).
    ViewCamera at(double part) const;
    /// Of picture `index` of `count`: the first is that of at(0), the last that of at(1).
    ViewCamera atFrame(std::uint32_t index, std::uint32_t count) const;

  private:
    explicit CameraPath(std::vector<ViewCamera> cameras) : cameras_(std::move(cameras)) {}
    std::vector<ViewCamera> cameras_;
};

}  // namespace pfvox::viewer
