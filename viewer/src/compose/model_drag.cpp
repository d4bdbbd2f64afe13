#include "compose/model_drag.hpp"

#include "compose/model_edits.hpp"

namespace pfvox::viewer {

ModelDrag::ModelDrag(const SceneEditor& editor, const Gizmo& gizmo, Handle handle, const glm::dvec2& grip)
    : gizmo_(gizmo),
      handle_(handle),
      grip_(grip),
      index_(*editor.selected()),
      start_(*editor.selectedModel()) {}

Result<void> ModelDrag::moveTo(const glm::dvec2& cursor, SceneEditor& editor) const {
    SceneModel model = start_;
    if (handle_ == Handle::Turn) {
        model = turnedAbout(std::move(model), gizmo_.origin(), gizmo_.turned(grip_, cursor));
    } else {
        model.translateMetres += gizmo_.moved(handle_, grip_, cursor);
    }
    return editor.setModel(index_, std::move(model), "drag");
}

}  // namespace pfvox::viewer
