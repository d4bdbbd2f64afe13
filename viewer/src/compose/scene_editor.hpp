// SceneEditor: a scene that is being composed: its document, what is selected, and every step that can be
// undone.
//
//     scene.toml -> reset() -> edits, undo(), redo() -> save() -> scene.toml
//
// Knows no window and no device. What an edit would make invalid is refused and changes nothing, so that the
// document can be written at any time.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

#include "compose/scene_change.hpp"

namespace pfvox::viewer {

class SceneEditor {
  public:
    static constexpr std::size_t kMaxUndoSteps = 1000;

    /// Another document: nothing to undo, nothing unsaved. `file` is empty as long as there is none; relative
    /// paths of models count from `folder`.
    void reset(Scene scene, std::filesystem::path file, std::filesystem::path folder);

    const Scene& scene() const { return scene_; }
    const std::filesystem::path& file() const { return file_; }
    const std::filesystem::path& folder() const { return folder_; }
    /// Grows whenever scene() becomes another.
    std::uint64_t revision() const { return revision_; }
    /// What was read or saved last.
    const Scene& saved() const { return saved_; }
    /// Whether scene() differs from it.
    bool isChanged() const { return changed_; }

    std::optional<std::size_t> selected() const { return selected_; }
    /// The selected model; null = none.
    const SceneModel* selectedModel() const { return selected_ ? &scene_.models[*selected_] : nullptr; }
    /// An index that there is not selects nothing.
    void select(std::optional<std::size_t> model);
    /// The next model (or the one before) in the list, around its end.
    void selectNext(int step);

    // Edits. Each ends the gesture before, unless it is of the same gesture: edits of one gesture (a drag,
    // say) are one step to undo. Errors: BadValue, LimitExceeded (what no scene file may hold), BadReference
    // (no such model).
    Result<void> addModel(SceneModel model);  ///< at the end; becomes selected
    Result<void> duplicateModel(std::size_t index,
                                const glm::dvec3& shiftMetres);  ///< behind it; becomes selected
    Result<void> removeModel(std::size_t index);
    Result<void> setModel(std::size_t index, SceneModel model, std::string_view gesture = {});
    Result<void> setSun(const Sun& sun, std::string_view gesture = {});
    Result<void> setSky(const Sky& sky, std::string_view gesture = {});
    Result<void> setProbes(const ProbeGridRequest& probes, std::string_view gesture = {});
    Result<void> setCameras(std::vector<Camera> cameras, std::string_view gesture = {});
    /// What follows is another step to undo.
    void endGesture() { gesture_.clear(); }
    /// The same, once the next edit has joined the step.
    void endGestureAfterNextEdit() { endsWithNext_ = true; }

    bool canUndo() const { return !undo_.empty(); }
    bool canRedo() const { return !redo_.empty(); }
    /// False when there is nothing to undo, to redo.
    bool undo();
    bool redo();
    /// What undo() takes back, "move 'hall'"; empty = nothing.
    std::string_view undoText() const { return undo_.empty() ? std::string_view{} : undo_.back().what; }
    std::string_view redoText() const { return redo_.empty() ? std::string_view{} : redo_.back().what; }

    /// Writes file(), complete or not at all. Errors: FileNotWritable (also without a file()).
    Result<void> save();
    /// Writes another file, which becomes file(); relative paths of models become those from its folder.
    /// Errors: FileNotWritable; then all is as before.
    Result<void> saveAs(const std::filesystem::path& file);

    /// Where the file of a model is.
    std::filesystem::path fileOf(const SceneModel& model) const;
    /// The path that a model has in this scene: relative to folder() when they have more than the root in
    /// common.
    std::string pathOf(const std::filesystem::path& modelFile) const;

  private:
    struct Step {
        std::string what;
        SceneChange change;
    };
    Result<void> edit(std::string what, SceneChange change, std::string_view gesture = {});
    Result<void> makeStep(std::string what, SceneChange change, std::string_view gesture);
    bool joinsLast(const SceneChange& change, std::string_view gesture);
    void changeTo(const SceneChange& change);
    void touched();

    Scene scene_;
    Scene saved_;
    std::filesystem::path file_;
    std::filesystem::path folder_;
    std::vector<Step> undo_;
    std::vector<Step> redo_;
    bool endsWithNext_ = false;
    std::string gesture_;  ///< that the last step of undo_ is of and may go on
    std::optional<std::size_t> selected_;
    std::uint64_t revision_ = 0;
    bool changed_ = false;
};

/// The name of a model for people: its name, else its path.
std::string labelOf(const SceneModel& model);

}  // namespace pfvox::viewer
