// The probe grid, the probes that light the scene, and one of them.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

#include "compose/model_edits.hpp"
#include "window/panels.hpp"
#include "window/widgets.hpp"

namespace pfvox::viewer {

namespace {

/// The whole grid, with the step it has, so that it encloses the models.
void fitToScene(Document& document) {
    const LoadedScene& loaded = document.shown()->loaded;
    const ProbeGridRequest& now = document.composer.editor.scene().probes;
    const Result<ProbeGrid> grid =
        fitProbeGrid({.stepMetres = now.stepMetres}, loaded.bounds, document.log());
    if (!grid) return document.log().addError(describe(grid.error()));
    document.composer.tell(document.composer.editor.setProbes(requestOf(*grid, now.proximityCells)));
}

std::string givenText(const ProbeGridRequest& probes) {
    std::vector<std::string_view> given;
    if (probes.position) given.emplace_back("start");
    if (probes.stepMetres) given.emplace_back("step");
    if (probes.count) given.emplace_back("counts");
    if (given.empty()) return "fitted to the scene by who bakes";
    return fmt::format("{} as in the file{}", fmt::join(given, ", "),
                       given.size() < 3 ? ", else fitted" : "");
}

void drawField(Document& document) {
    const ShownProbes* const probes = document.probes();
    ImGui::Separator();
    if (ImGui::Button("Load ...")) document.composer.dialog = Dialog::LoadProbes;
    if (probes == nullptr) {
        ImGui::SameLine();
        return note("none: probe-bake makes them");
    }
    ImGui::SameLine();
    if (ImGui::Button("Drop")) return document.dropProbes();
    ImGui::SameLine();
    text(probes->file.filename().string());
    std::vector<ProbeRecord> records;
    for (const ShownProbe& probe : probes->probes) records.push_back(probe.record);
    const ProbeCounts counts = countProbes(records);
    text(fmt::format("{} active, {} of them relocated; {} inactive", counts.active, counts.relocated,
                     counts.inactive));
    const ProbeResolution& maps = probes->info.resolution;
    note(fmt::format("maps {} depth, {} light, {} irradiance, {}", maps.depth, maps.light, maps.irradiance,
                     bytesText(probes->field.statistics().totalBytes())));
    if (!probes->ofThisScene || document.composer.editor.isChanged())
        note("baked for another state of the scene");
}

/// Which maps an atlas view shows: one page after the other, or one probe.
void drawAtlasChoice(Session& session) {
    const std::optional<AtlasLayout> maps = session.view.shownAtlas();
    if (!maps) return;
    ImGui::Separator();
    AtlasChoice& atlas = session.view.atlas;
    bool alone = atlas.probe >= 0;
    ImGui::BeginDisabled(!alone && !session.view.selectedProbe);
    ImGui::Checkbox("the selected probe alone", &alone);
    ImGui::EndDisabled();
    atlas.probe = alone && session.view.selectedProbe ? static_cast<std::int32_t>(*session.view.selectedProbe)
                  : alone                             ? atlas.probe
                                                      : -1;
    if (maps->pages < 2) return;
    ImGui::BeginDisabled(maps->page == 0);
    if (ImGui::ArrowButton("##page before", ImGuiDir_Left)) atlas.page = maps->page - 1;
    ImGui::EndDisabled();
    ImGui::SameLine();
    ImGui::BeginDisabled(maps->page + 1 == maps->pages);
    if (ImGui::ArrowButton("##page after", ImGuiDir_Right)) atlas.page = maps->page + 1;
    ImGui::EndDisabled();
    ImGui::SameLine();
    text(fmt::format("page {} of {}: probes {} to {}", maps->page + 1, maps->pages, maps->first,
                     maps->first + maps->count - 1));
}

}  // namespace

void drawProbeGrid(Document& document, View& view) {
    SceneEditor& editor = document.composer.editor;
    const ProbeGrid& grid = document.shown()->loaded.probes;
    ProbeGridRequest probes = editor.scene().probes;
    ImGui::Checkbox("show the grid (G)", &view.settings.showProbeGrid);
    ImGui::PushItemWidth(-84.0f);
    const ProbeGridRequest shown = requestOf(grid, probes.proximityCells);
    glm::dvec3 start = probes.position.value_or(*shown.position);
    glm::dvec3 step = probes.stepMetres.value_or(*shown.stepMetres);
    glm::uvec3 counts = probes.count.value_or(grid.counts);
    const auto set = [&](const char* gesture) { document.composer.tell(editor.setProbes(probes, gesture)); };
    if (dragVector("start (m)", start, {.speed = 0.02f}, editor)) {
        probes.position = start;
        set("start");
    }
    if (dragVector("step (m)", step, {.speed = 0.01f, .low = 1e-3, .high = 1e6}, editor)) {
        probes.stepMetres = step;
        set("step");
    }
    if (dragCounts("counts", counts, kMaxProbesPerAxis, editor)) {
        probes.count = counts;
        set("counts");
    }
    if (dragCounts("proximity", probes.proximityCells, 512, editor)) set("proximity");
    ImGui::PopItemWidth();
    if (ImGui::Button("Fit to the scene")) fitToScene(document);
    ImGui::SameLine();
    if (ImGui::Button("Automatic"))
        document.composer.tell(editor.setProbes({.proximityCells = probes.proximityCells}));
    note(fmt::format("{} probes, {}", grid.probeCount(), givenText(editor.scene().probes)));
}

void Panels::drawProbeDetail(Session& session) {
    if (!session.view.selectedProbe)
        return note(session.view.shownAtlas() ? "click a map for the probe's figures"
                                              : "click a probe of the grid for its figures");
    const std::uint32_t index = *session.view.selectedProbe;
    const ProbeGrid& grid = session.document.shown()->loaded.probes;
    const glm::uvec3 place = grid.placeOf(index);
    const glm::dvec3 at = session.document.placeOfProbe(index);
    ImGui::Separator();
    text(fmt::format("probe {} ({}, {}, {}) at {:.2f}, {:.2f}, {:.2f} m", index, place.x, place.y, place.z,
                     at.x, at.y, at.z));
    const ShownProbes* const probes = session.document.probes();
    if (probes == nullptr || !(probes->info.grid == grid)) return note("not baked at this place");
    const auto wanted = std::pair(probes->file, index);
    if (detailOf_ != wanted) {
        detailOf_ = wanted;
        Result<ProbeDetail> read = readProbeDetail(probes->file, index, session.document.log());
        if (!read) session.document.log().addError(describe(read.error()));
        detail_ = read ? std::optional(*std::move(read)) : std::nullopt;
    }
    if (!detail_) return;
    const ProbeDetail& d = *detail_;
    text(fmt::format("{}, error {}", toString(d.record.state),
                     d.record.error ? fmt::format("{:.3f}", *d.record.error) : "unknown"));
    text(fmt::format("indirect mean {:.3f} {:.3f} {:.3f}", d.meanLight.r, d.meanLight.g, d.meanLight.b));
    text(fmt::format("indirect max {:.3f} {:.3f} {:.3f}", d.maxLight.r, d.maxLight.g, d.maxLight.b));
    if (d.minDepthMetres) text(fmt::format("nearest surface {:.3f} m", *d.minDepthMetres));
    if (d.surfaceFraction)
        text(fmt::format("sees surfaces in {:.0f} % of all directions", 100.0f * *d.surfaceFraction));
    const float size =
        std::max(40.0f, (ImGui::GetContentRegionAvail().x - 2.0f * ImGui::GetStyle().ItemSpacing.x) / 3.0f);
    drawSmallMap("light", d.light.resolution, d.light.pixels, size);
    ImGui::SameLine();
    drawSmallMap("normals", d.normals.resolution, d.normals.pixels, size);
    ImGui::SameLine();
    drawSmallMap("depth", d.depth.resolution, d.depth.pixels, size);
    ImGui::NewLine();
}

void Panels::drawProbes(Session& session) {
    const ImVec2 window = ImGui::GetIO().DisplaySize;
    const ImVec2 place(std::max(kMargin, window.x - kPanelWidth - kMargin), 320.0f);
    if (beginPanel("Probes", probesOpen_, place, {kPanelWidth, std::max(120.0f, window.y - 328.0f)})) {
        if (session.document.shown() == nullptr) {
            note("nothing is open");
        } else {
            drawProbeGrid(session.document, session.view);
            drawField(session.document);
            drawAtlasChoice(session);
            if (session.document.shown() != nullptr) drawProbeDetail(session);
        }
    }
    ImGui::End();
}

}  // namespace pfvox::viewer
