// The models of the scene and the fields of the selected one.
#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "compose/model_edits.hpp"
#include "window/panels.hpp"
#include "window/widgets.hpp"

namespace pfvox::viewer {

namespace {

constexpr DragRange kDegrees{.speed = 0.5f, .low = -3600.0, .high = 3600.0, .format = "%.1f"};
constexpr DragRange kVoxelSize{.speed = 0.001f, .low = 1e-6, .high = 1e6, .format = "%.4f"};

enum class ScaleKind : std::uint8_t { File, Voxel, Cube };

ScaleKind scaleKindOf(const SceneModel& model) {
    return model.cubeEdgeMetres ? ScaleKind::Cube : model.metresPerVoxel ? ScaleKind::Voxel : ScaleKind::File;
}

const PlacedAsset* partOf(const Document& document, std::size_t model) {
    for (const PlacedAsset& part : document.shown()->loaded.parts) {
        if (part.model == model) return &part;
    }
    return nullptr;
}

/// The same size as now, said in another way.
SceneModel withScaleKind(SceneModel model, ScaleKind kind, const OctreeAsset& asset) {
    const double fileVoxel = asset.source.voxelSizeMetres;
    const double cube = sourceCube(asset).edgeVoxels();
    const double voxel = model.cubeEdgeMetres ? std::abs(model.cubeEdgeMetres->x) / cube
                                              : model.metresPerVoxel.value_or(fileVoxel);
    model.cubeEdgeMetres.reset();
    model.metresPerVoxel.reset();
    if (kind == ScaleKind::Voxel) model.metresPerVoxel = voxel;
    if (kind == ScaleKind::Cube) model.cubeEdgeMetres = glm::dvec3(voxel * cube);
    return model;
}

void drawScale(Document& document, std::size_t index, const SceneModel& now) {
    SceneEditor& editor = document.composer.editor;
    const PlacedAsset* const part = partOf(document, index);
    SceneModel model = now;
    int kind = static_cast<int>(scaleKindOf(model));
    if (ImGui::Combo("scale by", &kind, "the file's voxel size\0metres per voxel\0edges of the cube\0") &&
        part)
        document.composer.tell(
            editor.setModel(index, withScaleKind(model, static_cast<ScaleKind>(kind), *part->asset)));
    if (model.metresPerVoxel && dragNumber("m / voxel", *model.metresPerVoxel, kVoxelSize, editor))
        document.composer.tell(editor.setModel(index, model, "scale"));
    if (model.cubeEdgeMetres && dragVector("edges (m)", *model.cubeEdgeMetres, {.speed = 0.02f}, editor))
        document.composer.tell(editor.setModel(index, model, "scale"));
}

void drawCounts(const Document& document, std::size_t index) {
    const PlacedAsset* const part = partOf(document, index);
    if (part == nullptr) return note("hidden: not in memory");
    const WorldBounds box = boundsOf(*part->asset, part->worldFromAsset);
    const glm::dvec3 size = box.empty() ? glm::dvec3(0.0) : box.max - box.min;
    note(fmt::format("{} models, {} instances, {:.2f} x {:.2f} x {:.2f} m", part->asset->models.size(),
                     part->asset->instances.size(), size.x, size.y, size.z));
}

}  // namespace

void drawModelList(Document& document, Input& input) {
    SceneEditor& editor = document.composer.editor;
    commandButton(input, "Add ...", Command::AddModel);
    ImGui::SameLine();
    ImGui::BeginDisabled(!editor.selected());
    commandButton(input, "Duplicate", Command::Duplicate);
    ImGui::SameLine();
    commandButton(input, "Remove", Command::Remove);
    ImGui::EndDisabled();
    if (ImGui::BeginChild("models", {0.0f, 96.0f}, true)) {
        for (std::size_t i = 0; i < editor.scene().models.size(); ++i) {
            SceneModel model = editor.scene().models[i];
            ImGui::PushID(static_cast<int>(i));
            if (ImGui::Checkbox("##visible", &model.visible)) {
                document.composer.tell(editor.setModel(i, model));
            }
            ImGui::SameLine();
            if (ImGui::Selectable(labelOf(model).c_str(), editor.selected() == i)) editor.select(i);
            ImGui::PopID();
        }
        if (editor.scene().models.empty()) note("no models yet: add some, or drop .pf_vox files here");
    }
    ImGui::EndChild();
}

void drawSelectedModel(Document& document) {
    SceneEditor& editor = document.composer.editor;
    if (!editor.selected()) return note("click a model in the picture or in the list to select it");
    const std::size_t index = *editor.selected();
    SceneModel model = *editor.selectedModel();
    ImGui::PushID(static_cast<int>(index));
    ImGui::PushItemWidth(-84.0f);
    if (ImGui::InputText("name", &model.name)) document.composer.tell(editor.setModel(index, model, "name"));
    if (ImGui::IsItemDeactivated()) editor.endGesture();
    if (dragVector("place (m)", model.translateMetres, {}, editor))
        document.composer.tell(editor.setModel(index, model, "place"));
    glm::dvec3 degrees = glm::degrees(model.rotateRadians);
    if (dragVector("turn (deg)", degrees, kDegrees, editor)) {
        SceneModel turned = model;
        turned.rotateRadians = glm::radians(degrees);
        document.composer.tell(editor.setModel(index, turned, "turn"));
    }
    drawScale(document, index, editor.scene().models[index]);
    ImGui::PopItemWidth();
    note(model.path);
    drawCounts(document, index);
    ImGui::PopID();
}

}  // namespace pfvox::viewer
