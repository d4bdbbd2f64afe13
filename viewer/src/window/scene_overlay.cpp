// Boxes of models, probes and handles upon the picture.
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "window/panels.hpp"

namespace pfvox::viewer {

namespace {

constexpr ImU32 kBoxColor = IM_COL32(160, 200, 255, 120);
constexpr ImU32 kSelectedColor = IM_COL32(255, 190, 60, 255);
constexpr std::size_t kMostBoxes = 4000;
constexpr std::uint64_t kMostProbes = 30000;  // beyond that every so-manieth is drawn
constexpr double kNearProbeUnits = 7.0;
constexpr double kFarProbeUnits = 1.5;

ImVec2 at(const glm::dvec2& point) {
    return {static_cast<float>(point.x), static_cast<float>(point.y)};
}

class OverlayDrawing {
  public:
    OverlayDrawing(const Document& document, const View& view, const glm::dvec2& cursor)
        : document_(document),
          seen_(view),
          view_(view.projection()),
          cursor_(cursor),
          list_(ImGui::GetBackgroundDrawList()) {}

    void draw() {
        if (seen_.settings.showProbeGrid) drawProbes();
        const std::vector<PlacedAsset>& parts = document_.shown()->loaded.parts;
        const auto selected = document_.composer.editor.selected();
        for (std::size_t i = 0; i < std::min(parts.size(), kMostBoxes); ++i) {
            const bool isSelected = parts[i].model == selected;
            if (isSelected || seen_.settings.showBounds) drawBox(i, isSelected);
        }
        if (const std::optional<Gizmo> gizmo = seen_.gizmo()) drawGizmo(*gizmo);
    }

  private:
    void line(const glm::dvec3& a, const glm::dvec3& b, ImU32 color, float width) {
        const auto seen = view_.lineOf(a, b);
        if (seen) list_->AddLine(at(seen->first), at(seen->second), color, width);
    }

    /// Turned as the model is.
    void drawBox(std::size_t part, bool selected) {
        const WorldBounds& box = document_.shown()->assetBoxes[part];
        if (box.empty()) return;
        const Affine& world = document_.shown()->loaded.parts[part].worldFromAsset;
        const auto corner = [&](int i) {
            const glm::dvec3 p((i & 1) != 0 ? box.max.x : box.min.x, (i & 2) != 0 ? box.max.y : box.min.y,
                               (i & 4) != 0 ? box.max.z : box.min.z);
            return glm::dvec3(world * glm::dvec4(p, 1.0));
        };
        for (int i = 0; i < 8; ++i) {
            for (const int axis : {1, 2, 4}) {
                if ((i & axis) == 0)
                    line(corner(i), corner(i | axis), selected ? kSelectedColor : kBoxColor,
                         selected ? 2.0f : 1.0f);
            }
        }
    }

    ImU32 colorOf(std::uint32_t probe) const {
        const ShownProbes* const baked = document_.probes();
        if (baked == nullptr || !(baked->info.grid == document_.shown()->loaded.probes) ||
            probe >= baked->probes.size())
            return IM_COL32(235, 235, 235, 200);
        switch (baked->probes[probe].record.state) {
            case ProbeState::Active:
                return IM_COL32(90, 220, 120, 220);
            case ProbeState::Relocated:
                return IM_COL32(255, 200, 70, 220);
            case ProbeState::Inactive:
                return IM_COL32(235, 80, 70, 220);
        }
        return 0;
    }

    /// As spheres a tenth of a step wide, but never too small to be seen nor so large that they hide the
    /// scene.
    void drawProbes() {
        const ProbeGrid& grid = document_.shown()->loaded.probes;
        const double radius = 0.05 * std::min({grid.step.x, grid.step.y, grid.step.z});
        const auto every = static_cast<std::uint32_t>(1 + grid.probeCount() / kMostProbes);
        for (std::uint32_t i = 0; i < grid.probeCount(); i += every) drawProbe(i, radius);
        if (seen_.selectedProbe) drawProbe(*seen_.selectedProbe, radius);
    }

    void drawProbe(std::uint32_t index, double radius) {
        const glm::dvec3 place = document_.placeOfProbe(index);
        const auto point = view_.pointOf(place);
        if (!point || point->x < -9.0 || point->y < -9.0 || point->x > view_.windowSize().x + 9.0 ||
            point->y > view_.windowSize().y + 9.0)
            return;
        const double units = radius / view_.metresPerUnit(view_.depthOf(place));
        const auto r = static_cast<float>(std::clamp(units, kFarProbeUnits, kNearProbeUnits));
        list_->AddCircleFilled(at(*point), r, colorOf(index), 12);
        list_->AddCircle(at(*point), r, IM_COL32(0, 0, 0, 160), 12);
        if (seen_.selectedProbe == index) list_->AddCircle(at(*point), r + 3.0f, kSelectedColor, 20, 2.0f);
    }

    void drawGizmo(const Gizmo& gizmo) {
        const auto under = gizmo.handleAt(cursor_);
        const auto color = [&](Handle handle, ImU32 usual) {
            return under == handle ? kSelectedColor : usual;
        };
        constexpr ImU32 kTurn = IM_COL32(200, 200, 200, 200);
        for (int i = 0; i < 48; ++i) {
            const double step = 2.0 * std::numbers::pi / 48;
            line(gizmo.circleAt(i * step), gizmo.circleAt((i + 1) * step), color(Handle::Turn, kTurn), 2.0f);
        }
        drawSquare(gizmo, color(Handle::Ground, IM_COL32(255, 255, 255, 110)));
        drawArrow(gizmo, Handle::X, color(Handle::X, IM_COL32(240, 70, 60, 255)));
        drawArrow(gizmo, Handle::Y, color(Handle::Y, IM_COL32(90, 220, 80, 255)));
        drawArrow(gizmo, Handle::Z, color(Handle::Z, IM_COL32(80, 130, 255, 255)));
    }

    void drawArrow(const Gizmo& gizmo, Handle handle, ImU32 color) {
        line(gizmo.origin(), gizmo.tipOf(handle), color, 3.0f);
        const auto tip = view_.pointOf(gizmo.tipOf(handle));
        if (tip) list_->AddCircleFilled(at(*tip), 5.0f, color, 12);
    }

    void drawSquare(const Gizmo& gizmo, ImU32 color) {
        const glm::dvec3 o = gizmo.origin();
        const glm::dvec3 far = gizmo.tipOf(Handle::Ground);
        const std::array corners{o, glm::dvec3(far.x, o.y, o.z), far, glm::dvec3(o.x, o.y, far.z)};
        std::array<ImVec2, 4> points;
        for (std::size_t i = 0; i < corners.size(); ++i) {
            const auto point = view_.pointOf(corners[i]);
            if (!point) return;
            points[i] = at(*point);
        }
        list_->AddQuadFilled(points[0], points[1], points[2], points[3], color);
    }

    const Document& document_;
    const View& seen_;
    Projection view_;
    glm::dvec2 cursor_;
    ImDrawList* list_;
};

/// A frame around the map of the selected probe.
void drawSelectedMap(const View& view, const AtlasLayout& maps) {
    const auto corner = view.selectedProbe ? maps.cornerOf(*view.selectedProbe) : std::nullopt;
    if (!corner || maps.count == 1) return;
    const glm::dvec2 scale = view.windowSize / glm::dvec2(view.frames().size());
    const glm::dvec2 from = glm::dvec2(*corner) * scale;
    const glm::dvec2 to = from + static_cast<double>(maps.cell) * scale;
    ImGui::GetBackgroundDrawList()->AddRect(at(from), at(to), kSelectedColor, 0.0f, ImDrawFlags_None, 2.0f);
}

}  // namespace

void drawSceneOverlay(const Document& document, const View& view, const glm::dvec2& cursor) {
    if (document.shown() == nullptr) return;
    if (const std::optional<AtlasLayout> maps = view.shownAtlas()) return drawSelectedMap(view, *maps);
    OverlayDrawing(document, view, cursor).draw();
}

}  // namespace pfvox::viewer
