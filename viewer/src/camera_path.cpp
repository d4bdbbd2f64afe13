#include "camera_path.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

namespace pfvox::viewer {

namespace {

using Json = nlohmann::json;

std::optional<glm::dvec3> vectorOf(const Json& object, const char* key) {
    const auto found = object.find(key);
    if (found == object.end() || !found->is_array() || found->size() != 3) return std::nullopt;
    glm::dvec3 v(0.0);
    for (std::size_t i = 0; i < 3; ++i) {
        if (!(*found)[i].is_number()) return std::nullopt;
        v[static_cast<glm::length_t>(i)] = (*found)[i].get<double>();
        if (!std::isfinite(v[static_cast<glm::length_t>(i)])) return std::nullopt;
    }
    return v;
}

Result<ViewCamera> cameraOf(const Json& json, std::size_t index) {
    const auto wrong = [&](const char* what) {
        return fail(ErrorCode::BadValue, fmt::format("camera {}: {}", index + 1, what));
    };
    if (!json.is_object()) return wrong("is no object");
    const auto position = vectorOf(json, "position");
    const auto target = vectorOf(json, "target");
    if (!position) return wrong("position is not three numbers");
    if (!target) return wrong("target is not three numbers");
    if (*position == *target) return wrong("position and target are the same");
    ViewCamera camera{.position = *position, .target = *target};
    if (const auto fovY = json.find("fovYDegrees"); fovY != json.end()) {
        if (!fovY->is_number()) return wrong("fovYDegrees is no number");
        camera.fovYDegrees = fovY->get<double>();
    }
    if (!(camera.fovYDegrees >= 1.0 && camera.fovYDegrees <= 170.0))
        return wrong("fovYDegrees is not within 1 to 170");
    return camera;
}

/// Catmull-Rom: through b at 0 and c at 1.
glm::dvec3 spline(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d,
                  double t) {
    const glm::dvec3 linear = c - a;
    const glm::dvec3 square = 2.0 * a - 5.0 * b + 4.0 * c - d;
    const glm::dvec3 cube = 3.0 * (b - c) + d - a;
    return b + 0.5 * t * (linear + t * (square + t * cube));
}

}  // namespace

Result<CameraPath> CameraPath::parse(std::string_view text) {
    const Json json = Json::parse(text, nullptr, false);
    if (json.is_discarded()) return fail(ErrorCode::BadStructure, "the camera path is not JSON");
    const auto list = json.is_object() ? json.find("cameras") : json.end();
    if (list == json.end() || !list->is_array() || list->empty())
        return fail(ErrorCode::BadStructure, "the camera path has no list 'cameras'");
    std::vector<ViewCamera> cameras;
    for (std::size_t i = 0; i < list->size(); ++i) {
        PFVOX_TRY(const ViewCamera, camera, cameraOf((*list)[i], i));
        cameras.push_back(camera);
    }
    return CameraPath(std::move(cameras));
}

ViewCamera CameraPath::at(double part) const {
    const auto last = static_cast<double>(cameras_.size() - 1);
    const double along = std::clamp(part, 0.0, 1.0) * last;
    const auto index = static_cast<std::size_t>(std::min(std::floor(along), std::max(last - 1.0, 0.0)));
    const double t = along - static_cast<double>(index);
    const auto camera = [&](std::ptrdiff_t offset) -> const ViewCamera& {
        const auto wanted = static_cast<std::ptrdiff_t>(index) + offset;
        return cameras_[static_cast<std::size_t>(
            std::clamp<std::ptrdiff_t>(wanted, 0, static_cast<std::ptrdiff_t>(cameras_.size()) - 1))];
    };
    const ViewCamera &a = camera(-1), &b = camera(0), &c = camera(1), &d = camera(2);
    return {.position = spline(a.position, b.position, c.position, d.position, t),
            .target = spline(a.target, b.target, c.target, d.target, t),
            .fovYDegrees = b.fovYDegrees + t * (c.fovYDegrees - b.fovYDegrees)};
}

ViewCamera CameraPath::atFrame(std::uint32_t index, std::uint32_t count) const {
    return at(count < 2 ? 0.0 : static_cast<double>(index) / (count - 1));
}

}  // namespace pfvox::viewer
