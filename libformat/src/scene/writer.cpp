#include <fmt/format.h>

#include <pfvox/scene.hpp>

#include "io/files.hpp"
#include "scene/toml_text.hpp"

namespace pfvox {

namespace scene {

std::string tomlString(std::string_view text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') {
            out += '\\';
            out += c;
        } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
            out += fmt::format("\\u{:04x}", static_cast<unsigned char>(c));
        } else {
            out += c;
        }
    }
    return out + '"';
}

std::string tomlNumber(double value) {
    std::string text = fmt::format("{}", value);
    if (text.find_first_of(".en") == std::string::npos) text += ".0";
    return text;
}

std::string tomlVector(const glm::dvec3& v) {
    return fmt::format("[{}, {}, {}]", tomlNumber(v.x), tomlNumber(v.y), tomlNumber(v.z));
}

std::string tomlVector(const glm::uvec3& v) {
    return fmt::format("[{}, {}, {}]", v.x, v.y, v.z);
}

namespace {

std::string probesText(const ProbeGridRequest& probes) {
    std::string text;
    if (probes.position) text += fmt::format("probeGridPos = {}\n", tomlVector(*probes.position));
    if (probes.stepMetres) {
        const glm::dvec3 step = *probes.stepMetres;
        const bool uniform = step.x == step.y && step.y == step.z;
        text += fmt::format("probeGridStep = {}\n", uniform ? tomlNumber(step.x) : tomlVector(step));
    }
    if (probes.count) text += fmt::format("probeGridCount = {}\n", tomlVector(*probes.count));
    return text + fmt::format("proximityGridSize = {}\n", tomlVector(probes.proximityCells));
}

std::string skyText(const Sky& sky) {
    if (sky.isConstant()) return fmt::format("\n[sky]\nradiance = {}\n", tomlVector(sky.zenith));
    return fmt::format("\n[sky]\nzenith = {}\nhorizon = {}\nground = {}\n", tomlVector(sky.zenith),
                       tomlVector(sky.horizon), tomlVector(sky.ground));
}

std::string nameText(const std::string& name) {
    return name.empty() ? std::string() : fmt::format("name = {}\n", tomlString(name));
}

std::string cameraText(const Camera& camera) {
    return fmt::format("\n[[cameras]]\n{}position = {}\ntarget = {}\nfovYDegrees = {}\n",
                       nameText(camera.name), tomlVector(camera.position), tomlVector(camera.target),
                       tomlNumber(camera.fovYDegrees));
}

std::string modelText(const SceneModel& model) {
    std::string text =
        fmt::format("\n[[models]]\n{}path = {}\n", nameText(model.name), tomlString(model.path));
    text += fmt::format("translateVec = {}\nrotateVec = {}\n", tomlVector(model.translateMetres),
                        tomlVector(model.rotateRadians));
    if (model.cubeEdgeMetres) text += fmt::format("scaleVec = {}\n", tomlVector(*model.cubeEdgeMetres));
    if (model.metresPerVoxel) text += fmt::format("metresPerVoxel = {}\n", tomlNumber(*model.metresPerVoxel));
    if (!model.visible) text += "visible = false\n";
    return text;
}

}  // namespace

}  // namespace scene

std::string sceneText(const Scene& scene) {
    std::string text = scene::probesText(scene.probes);
    text += fmt::format("\n[sun]\ndirection = {}\nirradiance = {}\n", scene::tomlVector(scene.sun.direction),
                        scene::tomlVector(scene.sun.irradiance));
    text += scene::skyText(scene.sky);
    for (const Camera& camera : scene.cameras) text += scene::cameraText(camera);
    for (const SceneModel& model : scene.models) text += scene::modelText(model);
    return text;
}

Result<void> writeScene(const std::filesystem::path& file, const Scene& scene) {
    const std::string text = sceneText(scene);
    DiagnosticList ignored;
    PFVOX_TRY(const Scene, again, parseScene(text, file, Limits{}, ignored));
    if (again != scene)
        return fail(ErrorCode::BadValue, "this scene cannot be written so that it reads back");
    return io::writeFileAtomically(file, std::as_bytes(std::span(text)));
}

}  // namespace pfvox
