// ModelDrag: a model that the mouse holds by a handle, from pressing the button to letting it go.
#pragma once

#include "compose/gizmo.hpp"
#include "compose/scene_editor.hpp"

namespace pfvox::viewer {

class ModelDrag {
  public:
    /// Precondition: the editor has a selected model. `grip` is the point of the window where the button went
    /// down.
    ModelDrag(const SceneEditor& editor, const Gizmo& gizmo, Handle handle, const glm::dvec2& grip);

    Handle handle() const { return handle_; }
    /// The model follows the cursor; all of it is one step to undo. Errors: those of SceneEditor::setModel.
    Result<void> moveTo(const glm::dvec2& cursor, SceneEditor& editor) const;

  private:
    Gizmo gizmo_;
    Handle handle_;
    glm::dvec2 grip_;
    std::size_t index_;
    SceneModel start_;
};

}  // namespace pfvox::viewer
