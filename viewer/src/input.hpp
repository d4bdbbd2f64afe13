// Input: what commands, clicks and drags do to the document and its view.
//
//     keys, menus, mouse -> [Input] -> document, view
#pragma once

#include <filesystem>
#include <functional>
#include <optional>

#include "commands.hpp"
#include "compose/model_drag.hpp"
#include "interaction.hpp"
#include "view.hpp"

namespace pfvox::viewer {

class Input {
  public:
    /// `screenshotFolder`: empty = where the program runs.
    Input(Document& document, View& view, std::filesystem::path screenshotFolder)
        : document_(&document), view_(&view), screenshotFolder_(std::move(screenshotFolder)) {}

    /// While a dialog is to open or a question waits for its answer, nothing: a key that comes then was meant
    /// for that.
    void execute(const KeyBinding& binding);
    /// Selects a probe of the grid that is drawn, else as View::pickAt().
    void clickAt(glm::dvec2 parts);
    /// Takes hold of the handle there, if there is one.
    bool grabAt(glm::dvec2 parts);
    void drag(const Drag& drag);
    /// The present view becomes a camera of the scene.
    void addCamera();
    /// Ends the program, after the question about unsaved changes.
    void quit();
    bool wantsToQuit() const { return quit_; }

  private:
    void executeEdit(const KeyBinding& binding);
    void moveSelected(MoveDirection direction);
    void changeSelected(const std::function<SceneModel(const SceneModel&, const WorldBounds&)>& change);

    Document* document_;
    View* view_;
    std::filesystem::path screenshotFolder_;
    std::optional<ModelDrag> drag_;
    bool quit_ = false;
};

}  // namespace pfvox::viewer
