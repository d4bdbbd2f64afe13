#include "window/panels.hpp"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace pfvox::viewer {

namespace {

constexpr float kMargin = 10.0f;
constexpr float kPanelWidth = 320.0f;

void text(const std::string& line) {
    ImGui::TextUnformatted(line.c_str(), line.c_str() + line.size());
}

/// Place and size until the user chooses others.
void place(ImVec2 at, ImVec2 size) {
    ImGui::SetNextWindowPos(at, ImGuiCond_FirstUseEver);
    ImGui::SetNextWindowSize(size, ImGuiCond_FirstUseEver);
}

std::string bytesText(std::uint64_t bytes) {
    const auto value = static_cast<double>(bytes);
    if (bytes < 1u << 20) return fmt::format("{:.1f} KiB", value / 1024.0);
    return bytes < 1u << 30 ? fmt::format("{:.1f} MiB", value / 1048576.0)
                            : fmt::format("{:.2f} GiB", value / 1073741824.0);
}

void drawCounts(const gpu::SceneStatistics& s) {
    text(fmt::format("{} models, {} instances, {} materials", s.models, s.instances, s.materials));
    text(fmt::format("{} voxels in {} regions", s.voxels, s.regions));
    const double perVoxel =
        s.voxels == 0 ? 0.0 : static_cast<double>(s.totalBytes()) / static_cast<double>(s.voxels);
    text(fmt::format("{} on the device, {:.3f} bytes/voxel", bytesText(s.totalBytes()), perVoxel));
}

void drawModels(const LoadedScene& loaded) {
    for (const PlacedAsset& part : loaded.parts) {
        const SceneModel& model = loaded.scene.models[part.model];
        const std::string name = model.name.empty() ? model.path : model.name;
        if (!ImGui::TreeNode(&part, "%s", name.c_str())) continue;
        const auto& p = part.worldFromAsset[3];
        text(fmt::format("{}\nat {:.2f}, {:.2f}, {:.2f} m", model.path, p.x, p.y, p.z));
        text(fmt::format("{} models, {} instances", part.asset->models.size(), part.asset->instances.size()));
        ImGui::TreePop();
    }
}

void drawPick(const Pick& pick) {
    ImGui::Separator();
    const auto c = glm::vec4(pick.baseColor) / 255.0f;
    ImGui::ColorButton("base colour", ImVec4(c.x, c.y, c.z, 1.0f));
    ImGui::SameLine();
    text(fmt::format("voxel {}, {}, {}", pick.voxel.x, pick.voxel.y, pick.voxel.z));
    text(fmt::format("model {}\ninstance {}\nmaterial {}", pick.model, pick.instance, pick.material));
    text(fmt::format("at {:.3f}, {:.3f}, {:.3f} m", pick.point.x, pick.point.y, pick.point.z));
    text(fmt::format("{:.3f} m away", pick.distanceMetres));
}

void drawScene(Session& session) {
    place({kMargin, kMargin}, {kPanelWidth, 260.0f});
    if (ImGui::Begin("Scene")) {
        const ShownScene* const shown = session.shown();
        if (session.isLoading()) text("loading ...");
        if (shown == nullptr && !session.isLoading()) text("drop a .pf_vox file, a scene or a folder here");
        if (shown != nullptr) {
            text(shown->path.file.filename().string());
            drawCounts(shown->scene.statistics());
            drawModels(shown->loaded);
        }
        if (session.pick()) drawPick(*session.pick());
    }
    ImGui::End();
}

void drawSun(Lighting& light) {
    // As two angles: where the sun stands.
    const glm::vec3 towards = -glm::normalize(light.sunDirection);
    float height = glm::degrees(std::asin(std::clamp(towards.y, -1.0f, 1.0f)));
    float azimuth = glm::degrees(std::atan2(towards.x, towards.z));
    const bool turned = ImGui::SliderFloat("sun azimuth", &azimuth, -180.0f, 180.0f, "%.0f deg");
    const bool raised = ImGui::SliderFloat("sun height", &height, -89.0f, 89.0f, "%.0f deg");
    if (turned || raised) {
        const float a = glm::radians(azimuth);
        const float h = glm::radians(height);
        light.sunDirection = -glm::vec3(std::cos(h) * std::sin(a), std::sin(h), std::cos(h) * std::cos(a));
    }
    const ImGuiColorEditFlags flags = ImGuiColorEditFlags_HDR | ImGuiColorEditFlags_Float;
    ImGui::ColorEdit3("sun", &light.sunIrradiance.x, flags);
    ImGui::ColorEdit3("zenith", &light.skyZenith.x, flags);
    ImGui::ColorEdit3("horizon", &light.skyHorizon.x, flags);
    ImGui::ColorEdit3("ground", &light.skyGround.x, flags);
}

/// A slider for a double.
void slider(const char* label, double& value, double low, double high, const char* format) {
    ImGui::SliderScalar(label, ImGuiDataType_Double, &value, &low, &high, format, ImGuiSliderFlags_AlwaysClamp);
}

void drawRendering(Session& session) {
    place({kMargin, 280.0f}, {kPanelWidth, 310.0f});
    if (ImGui::Begin("Rendering")) {
        if (ImGui::BeginCombo("view", std::string(toString(session.mode)).c_str())) {
            for (std::size_t i = 0; i < kViewModes; ++i) {
                const auto mode = static_cast<ViewMode>(i);
                if (ImGui::Selectable(std::string(toString(mode)).c_str(), mode == session.mode)) session.mode = mode;
            }
            ImGui::EndCombo();
        }
        drawSun(session.lighting);
        slider("exposure", session.settings.exposureStops, -8.0, 8.0, "%.1f stops");
        slider("detail", session.settings.lodPixels, 0.0, 16.0, "%.1f pixels");
        slider("resolution", session.settings.renderScale, 0.25, 1.0, "%.2f");
        ImGui::Checkbox("anti-aliasing over frames", &session.settings.antiAliasing);
        if (session.shown() != nullptr && ImGui::Button("light of the scene"))
            session.lighting = lightingOf(session.shown()->loaded.scene);
    }
    ImGui::End();
}

void drawStatistics(const Session& session) {
    const ImVec2 window = ImGui::GetIO().DisplaySize;
    place({std::max(kMargin, window.x - kPanelWidth - kMargin), kMargin}, {kPanelWidth, 190.0f});
    if (ImGui::Begin("Statistics")) {
        text(session.device().info().name);
        const std::vector<float> times(session.frameTimesMs().begin(), session.frameTimesMs().end());
        if (!times.empty()) {
            const PictureStatistics& s = session.statistics();
            std::vector<float> sorted = times;
            std::sort(sorted.begin(), sorted.end());
            const float worst = sorted.back();
            // A single slow frame, the first above all, does not flatten the others.
            const float top = std::min(worst, 3.0f * sorted[sorted.size() / 2]);
            ImGui::PlotLines("##frames", times.data(), static_cast<int>(times.size()), 0, nullptr, 0.0f, top,
                             ImVec2(ImGui::GetContentRegionAvail().x, 50.0f));
            text(fmt::format("frame {:.2f} ms on the device, worst {:.1f}", s.gpuMs, worst));
            const auto rays = static_cast<double>(s.cameraRays);
            text(fmt::format("{:.2f} million camera rays/s", s.gpuMs > 0.0 ? rays / s.gpuMs * 1e-3 : 0.0));
            text(fmt::format("{:.1f} steps a camera ray", rays > 0.0 ? static_cast<double>(s.steps) / rays : 0.0));
            text(fmt::format("{} frames in the picture", session.frames().frames()));
        }
        const gpu::MemoryUse memory = session.device().memory();
        text(fmt::format("memory {}, at most {}", bytesText(memory.currentBytes), bytesText(memory.peakBytes)));
    }
    ImGui::End();
}

void drawLog(const Session& session) {
    const ImVec2 window = ImGui::GetIO().DisplaySize;
    place({kPanelWidth + 2.0f * kMargin, std::max(kMargin, window.y - 140.0f)},
          {std::max(200.0f, window.x - kPanelWidth - 3.0f * kMargin), 130.0f});
    if (ImGui::Begin("Log")) {
        for (const Message& message : session.log().messages()) {
            const ImVec4 colour = message.kind == MessageKind::Error     ? ImVec4(1.0f, 0.45f, 0.4f, 1.0f)
                                  : message.kind == MessageKind::Warning ? ImVec4(1.0f, 0.85f, 0.4f, 1.0f)
                                                                         : ImVec4(0.85f, 0.85f, 0.85f, 1.0f);
            ImGui::PushStyleColor(ImGuiCol_Text, colour);
            ImGui::PushTextWrapPos(0.0f);
            text(message.text);
            ImGui::PopTextWrapPos();
            ImGui::PopStyleColor();
        }
        if (ImGui::GetScrollY() >= ImGui::GetScrollMaxY()) ImGui::SetScrollHereY(1.0f);
    }
    ImGui::End();
}

void drawHelp(Session& session) {
    const ImVec2 window = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({0.5f * window.x, 0.5f * window.y}, ImGuiCond_Appearing, {0.5f, 0.5f});
    if (ImGui::Begin("Keys", &session.showHelp, ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings)) {
        const auto row = [](std::string_view keys, std::string_view what) {
            text(fmt::format("{:<22}{}", keys, what));
        };
        for (const HeldBinding& binding : heldBindings()) row(binding.keyText, binding.what);
        ImGui::Separator();
        for (const KeyBinding& binding : keyBindings()) row(binding.keyText, binding.what);
    }
    ImGui::End();
}

void drawStrip(const Session& session, const std::string& message) {
    const ImVec2 window = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({0.0f, window.y}, ImGuiCond_Always, {0.0f, 1.0f});
    ImGui::SetNextWindowSize({window.x, 0.0f});
    ImGui::PushStyleColor(ImGuiCol_WindowBg, ImVec4(0.45f, 0.08f, 0.06f, 0.95f));
    constexpr ImGuiWindowFlags kFlags = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoSavedSettings |
                                        ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoFocusOnAppearing;
    if (ImGui::Begin("##strip", nullptr, kFlags)) {
        ImGui::PushTextWrapPos(0.0f);
        text(message);
        ImGui::PopTextWrapPos();
        if (ImGui::SmallButton("close")) session.log().dismissStrip();
    }
    ImGui::End();
    ImGui::PopStyleColor();
}

}  // namespace

void drawPanels(Session& session) {
    if (session.settings.showWindows) {
        drawScene(session);
        drawRendering(session);
        drawStatistics(session);
        drawLog(session);
    }
    if (session.showHelp) drawHelp(session);
    if (const std::optional<std::string> strip = session.log().strip()) drawStrip(session, *strip);
}

}  // namespace pfvox::viewer
