#include "window/panels.hpp"

#include <fmt/format.h>
#include <imgui_internal.h>  // which window is in front

#include <algorithm>
#include <vector>

#include "window/widgets.hpp"

namespace pfvox::viewer {

namespace {

void drawCounts(const gpu::SceneStatistics& s) {
    text(fmt::format("{} models, {} instances, {} materials", s.models, s.instances, s.materials));
    text(fmt::format("{} voxels in {} regions", s.voxels, s.regions));
    const double perVoxel =
        s.voxels == 0 ? 0.0 : static_cast<double>(s.totalBytes()) / static_cast<double>(s.voxels);
    text(fmt::format("{} on the device, {:.3f} bytes/voxel", bytesText(s.totalBytes()), perVoxel));
}

void drawPick(const Document& document, const Pick& pick) {
    ImGui::Separator();
    const auto c = glm::vec4(pick.baseColor) / 255.0f;
    ImGui::ColorButton("base color", ImVec4(c.x, c.y, c.z, 1.0f));
    ImGui::SameLine();
    text(fmt::format("voxel {}, {}, {}", pick.voxel.x, pick.voxel.y, pick.voxel.z));
    text(fmt::format("model {}\ninstance {}\nmaterial {}", pick.model, pick.instance, pick.material));
    text(fmt::format("at {:.3f}, {:.3f}, {:.3f} m", pick.point.x, pick.point.y, pick.point.z));
    const std::uint32_t probe = nearestProbe(document.shown()->loaded.probes, pick.point);
    const double toProbe = glm::length(document.placeOfProbe(probe) - pick.point);
    text(fmt::format("{:.3f} m away; nearest probe {}, {:.2f} m", pick.distanceMetres, probe, toProbe));
}

/// Those that took part in the last frame.
void drawPasses(const PassTimes& times) {
    const double sum = sumOf(times);
    if (sum <= 0.0 || !ImGui::BeginTable("passes", 3)) return;
    for (std::size_t i = 0; i < times.size(); ++i) {
        if (times[i] <= 0.0) continue;
        ImGui::TableNextColumn();
        text(std::string(toString(static_cast<Pass>(i))));
        ImGui::TableNextColumn();
        text(millisecondsText(times[i]));
        ImGui::TableNextColumn();
        ImGui::ProgressBar(static_cast<float>(times[i] / sum), {-1.0f, ImGui::GetTextLineHeight()}, "");
    }
    ImGui::EndTable();
}

void drawHelp(View& view) {
    const ImVec2 window = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({0.5f * window.x, 0.5f * window.y}, ImGuiCond_Appearing, {0.5f, 0.5f});
    ImGui::SetNextWindowSize({std::min(780.0f, window.x), std::min(680.0f, window.y)}, ImGuiCond_Appearing);
    if (ImGui::Begin("Keys", &view.showHelp, ImGuiWindowFlags_NoSavedSettings)) {
        const auto row = [](std::string_view keys, std::string_view what) {
            text(fmt::format("{:<21} {}", keys, what));
        };
        for (const HeldBinding& binding : heldBindings()) row(binding.keyText, binding.what);
        ImGui::Separator();
        ImGui::Columns(2, nullptr, false);
        const std::span<const KeyBinding> all = keyBindings();
        for (std::size_t i = 0; i < all.size(); ++i) {
            if (i == (all.size() + 1) / 2) ImGui::NextColumn();
            row(all[i].keyText, all[i].what);
        }
        ImGui::Columns();
    }
    ImGui::End();
}

void drawStrip(MessageLog& log, const std::string& message) {
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
        if (ImGui::SmallButton("close")) log.dismissStrip();
        // Above the other windows whatever was clicked last, but below what asks.
        if (!ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup))
            ImGui::BringWindowToDisplayFront(ImGui::GetCurrentWindow());
    }
    ImGui::End();
    ImGui::PopStyleColor();
}

}  // namespace

void Panels::drawScene(Session& session) {
    const ImVec2 window = ImGui::GetIO().DisplaySize;
    const float height = std::clamp(window.y - 286.0f, 200.0f, 440.0f);
    if (beginPanel("Scene", sceneOpen_, {kMargin, kMenuHeight + kMargin}, {kPanelWidth, height})) {
        const ShownScene* const shown = session.document.shown();
        if (session.document.isLoading() || session.document.composer.isReading()) text("loading ...");
        if (shown == nullptr && !session.document.isLoading())
            note("Drop a .pf_vox file, a scene or a folder here, or open one with Ctrl+O. H shows all keys.");
        if (shown != nullptr) {
            text(nameOf(session.document));
            drawCounts(shown->scene.statistics());
            drawModelList(session.document, session.input);
            drawSelectedModel(session.document);
            if (session.view.pick()) drawPick(session.document, *session.view.pick());
        }
    }
    ImGui::End();
}

void Panels::drawStatistics(const Document& document, const View& view) {
    const ImVec2 window = ImGui::GetIO().DisplaySize;
    const ImVec2 place(std::max(kMargin, window.x - kPanelWidth - kMargin), kMenuHeight + kMargin);
    if (beginPanel("Statistics", statisticsOpen_, place, {kPanelWidth, 284.0f})) {
        text(document.device().info().name);
        const std::vector<float> times(view.frameTimesMs().begin(), view.frameTimesMs().end());
        if (!times.empty()) {
            const PictureStatistics& s = view.statistics();
            std::vector<float> sorted = times;
            std::sort(sorted.begin(), sorted.end());
            const float worst = sorted.back();
            // A single slow frame, the first above all, does not flatten the others.
            const float top = std::min(worst, 3.0f * sorted[sorted.size() / 2]);
            ImGui::PlotLines("##frames", times.data(), static_cast<int>(times.size()), 0, nullptr, 0.0f, top,
                             ImVec2(ImGui::GetContentRegionAvail().x, 34.0f));
            text(fmt::format("frame {} on the device, worst {}", millisecondsText(s.gpuMs),
                             millisecondsText(worst)));
            const auto rays = static_cast<double>(s.cameraRays);
            text(fmt::format("{:.2f} million camera rays/s", s.gpuMs > 0.0 ? rays / s.gpuMs * 1e-3 : 0.0));
            const double secondary = static_cast<double>(s.sunRays + s.ambientRays + s.reflectionRays);
            text(fmt::format("{:.2f} million rays/s of light",
                             s.gpuMs > 0.0 ? secondary / s.gpuMs * 1e-3 : 0.0));
            text(fmt::format("{:.1f} steps a camera ray",
                             rays > 0.0 ? static_cast<double>(s.steps) / rays : 0.0));
            drawPasses(s.passMs);
            text(fmt::format("{} frames in the picture", view.frames().frames()));
        }
        const gpu::MemoryUse memory = document.device().memory();
        text(fmt::format("memory {}, at most {}", bytesText(memory.currentBytes),
                         bytesText(memory.peakBytes)));
    }
    ImGui::End();
}

void Panels::drawLog(const MessageLog& log) {
    const ImVec2 window = ImGui::GetIO().DisplaySize;
    const ImVec2 place(kPanelWidth + 2.0f * kMargin, std::max(kMargin, window.y - 108.0f));
    const ImVec2 size(std::max(200.0f, window.x - 2.0f * kPanelWidth - 4.0f * kMargin), 100.0f);
    if (beginPanel("Log", logOpen_, place, size)) {
        for (const Message& message : log.messages()) {
            const ImVec4 color = message.kind == MessageKind::Error     ? ImVec4(1.0f, 0.45f, 0.4f, 1.0f)
                                 : message.kind == MessageKind::Warning ? ImVec4(1.0f, 0.85f, 0.4f, 1.0f)
                                                                        : ImVec4(0.85f, 0.85f, 0.85f, 1.0f);
            ImGui::PushStyleColor(ImGuiCol_Text, color);
            ImGui::PushTextWrapPos(0.0f);
            text(message.text);
            ImGui::PopTextWrapPos();
            ImGui::PopStyleColor();
        }
        if (ImGui::GetScrollY() >= ImGui::GetScrollMaxY()) ImGui::SetScrollHereY(1.0f);
    }
    ImGui::End();
}

std::string nameOf(const Document& document) {
    if (document.shown() == nullptr) return {};
    const std::filesystem::path& file = document.shown()->path.file;
    const std::string name = file.empty() ? "new scene" : file.filename().string();
    return document.composer.editor.isChanged() ? name + "*" : name;
}

void Panels::draw(Session& session) {
    if (session.view.settings.showWindows) {
        drawSceneOverlay(session.document, session.view,
                         {ImGui::GetIO().MousePos.x, ImGui::GetIO().MousePos.y});
        drawMenuBar(session);
        if (sceneOpen_) drawScene(session);
        if (renderingOpen_) drawRendering(session);
        if (statisticsOpen_) drawStatistics(session.document, session.view);
        if (probesOpen_) drawProbes(session);
        if (logOpen_) drawLog(session.document.log());
    }
    if (session.view.showHelp) drawHelp(session.view);
    if (const std::optional<std::string> strip = session.document.log().strip())
        drawStrip(session.document.log(), *strip);
    drawDialogs(session.document);
}

}  // namespace pfvox::viewer
