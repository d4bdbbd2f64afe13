// Sun and sky of the scene, and how it is drawn.
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "window/panels.hpp"
#include "window/widgets.hpp"

namespace pfvox::viewer {

namespace {

void drawSun(Composer& composer) {
    SceneEditor& editor = composer.editor;
    Sun sun = editor.scene().sun;
    // As two angles: where the sun stands. Its length says nothing.
    const glm::dvec3 towards = -glm::normalize(sun.direction);
    double height = glm::degrees(std::asin(std::clamp(towards.y, -1.0, 1.0)));
    double azimuth = glm::degrees(std::atan2(towards.x, towards.z));
    const bool turned = slider("sun azimuth", azimuth, -180.0, 180.0, "%.0f deg");
    endStep(turned, editor);
    const bool raised = slider("sun height", height, -89.0, 89.0, "%.0f deg");
    endStep(raised, editor);
    if (turned || raised) {
        const double a = glm::radians(azimuth);
        const double h = glm::radians(height);
        sun.direction = -glm::dvec3(std::cos(h) * std::sin(a), std::sin(h), std::cos(h) * std::cos(a));
        composer.tell(editor.setSun(sun, "direction"));
    }
    // Strength apart from the color: the largest channel.
    double strength = std::max({sun.irradiance.r, sun.irradiance.g, sun.irradiance.b});
    glm::dvec3 color = strength > 0.0 ? sun.irradiance / strength : glm::dvec3(1.0);
    const bool tinted = editColor("sun color", color, editor);
    const bool scaled =
        dragNumber("sun strength", strength, {.speed = 0.02f, .low = 0.0, .high = 1e6}, editor);
    if (tinted || scaled) {
        sun.irradiance = strength * color;
        composer.tell(editor.setSun(sun, tinted ? "color" : "strength"));
    }
}

}  // namespace

void drawSunAndSky(Composer& composer) {
    SceneEditor& editor = composer.editor;
    drawSun(composer);
    Sky sky = editor.scene().sky;
    const bool zenith = editColor("zenith", sky.zenith, editor);
    const bool horizon = editColor("horizon", sky.horizon, editor);
    const bool ground = editColor("ground", sky.ground, editor);
    if (zenith || horizon || ground) composer.tell(editor.setSky(sky, "sky"));
}

void Panels::drawRendering(Session& session) {
    const ImVec2 window = ImGui::GetIO().DisplaySize;
    if (beginPanel("Rendering", renderingOpen_, {kMargin, std::max(470.0f, window.y - 250.0f)},
                   {kPanelWidth, 242.0f})) {
        ImGui::PushItemWidth(-96.0f);
        if (ImGui::BeginCombo("view", std::string(toString(session.view.mode)).c_str())) {
            for (const ViewEntry& view : viewModes()) {
                const bool chosen =
                    ImGui::Selectable(std::string(view.name).c_str(), view.mode == session.view.mode);
                if (chosen) session.input.execute(*bindingOf(Command::ShowView, static_cast<int>(view.mode)));
            }
            ImGui::EndCombo();
        }
        if (session.document.shown() != nullptr &&
            ImGui::CollapsingHeader("sun and sky", ImGuiTreeNodeFlags_DefaultOpen))
            drawSunAndSky(session.document.composer);
        if (session.document.shown() != nullptr && session.document.probes() == nullptr)
            note(
                "No probes: indirect light is an approximation from what is near by. probe-bake computes "
                "it.");
        if (ImGui::CollapsingHeader("picture", ImGuiTreeNodeFlags_DefaultOpen)) {
            slider("exposure", session.view.settings.exposureStops, -8.0, 8.0, "%.1f stops");
            if (ImGui::BeginCombo("tone map", std::string(toString(session.view.settings.toneMap)).c_str())) {
                for (const ToneMapEntry& map : toneMaps()) {
                    if (ImGui::Selectable(std::string(map.name).c_str(),
                                          map.toneMap == session.view.settings.toneMap))
                        session.view.settings.toneMap = map.toneMap;
                }
                ImGui::EndCombo();
            }
            slider("detail", session.view.settings.lodPixels, 0.0, 16.0, "%.1f pixels");
            slider("resolution", session.view.settings.renderScale, 0.25, 1.0, "%.2f");
            Settings& settings = session.view.settings;
            ImGui::Checkbox("ground", session.document.showsSingleModel() ? &settings.modelGround
                                                                          : &settings.sceneGround);
            ImGui::Checkbox("anti-aliasing over frames", &session.view.settings.antiAliasing);
        }
        ImGui::PopItemWidth();
    }
    ImGui::End();
}

}  // namespace pfvox::viewer
