#include "compose/scene_editor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>
#include <utility>

namespace pfvox::viewer {

namespace fs = std::filesystem;

namespace {

fs::path absolutePath(const fs::path& path) {
    std::error_code error;
    const fs::path absolute = fs::absolute(path, error);
    return (error ? path : absolute).lexically_normal();
}

/// "../../a.pf_vox" from a folder; absolute when they have nothing but the root in common.
std::string pathFrom(const fs::path& folder, const fs::path& file) {
    const fs::path base = absolutePath(folder.empty() ? fs::path(".") : folder / ".").parent_path();
    const fs::path target = absolutePath(file);
    const fs::path relative = target.lexically_relative(base);
    const auto steps = std::distance(base.begin(), base.end()) - 1;  // without the root
    const auto up = std::ranges::count(relative, fs::path(".."));
    const bool farAway = up > 0 && up >= steps;
    return (relative.empty() || farAway ? target : relative).generic_string();
}

std::string whatOf(const SceneModel& before, const SceneModel& after) {
    const std::string name = labelOf(after);
    if (before.visible != after.visible) return fmt::format("{} '{}'", after.visible ? "show" : "hide", name);
    if (before.name != after.name) return fmt::format("name '{}'", name);
    if (before.cubeEdgeMetres != after.cubeEdgeMetres || before.metresPerVoxel != after.metresPerVoxel)
        return fmt::format("scale '{}'", name);
    return fmt::format("{} '{}'", before.rotateRadians != after.rotateRadians ? "rotate" : "move", name);
}

}  // namespace

std::string labelOf(const SceneModel& model) {
    return model.name.empty() ? model.path : model.name;
}

void SceneEditor::reset(Scene scene, fs::path file, fs::path folder) {
    scene_ = std::move(scene);
    saved_ = scene_;
    file_ = std::move(file);
    folder_ = std::move(folder);
    undo_.clear();
    redo_.clear();
    gesture_.clear();
    endsWithNext_ = false;
    selected_.reset();
    touched();
}

void SceneEditor::touched() {
    ++revision_;
    changed_ = scene_ != saved_;
}

void SceneEditor::select(std::optional<std::size_t> model) {
    if (selected_ != model) endGesture();
    selected_ = model && *model < scene_.models.size() ? model : std::nullopt;
}

void SceneEditor::selectNext(int step) {
    const auto count = static_cast<std::ptrdiff_t>(scene_.models.size());
    if (count == 0) return select(std::nullopt);
    const std::ptrdiff_t from = selected_ ? static_cast<std::ptrdiff_t>(*selected_) : (step > 0 ? -1 : count);
    select(static_cast<std::size_t>(((from + step) % count + count) % count));
}

// ---- Edits -----------------------------------------------------------------------------------------------

bool SceneEditor::joinsLast(const SceneChange& change, std::string_view gesture) {
    if (gesture.empty() || gesture != gesture_ || undo_.empty()) return false;
    std::optional<SceneChange> both = joined(undo_.back().change, change);
    if (!both) return false;
    undo_.back().change = *std::move(both);
    if (changesNothing(undo_.back().change)) {  // dragged back to where it was
        undo_.pop_back();
        gesture_.clear();
    }
    return true;
}

Result<void> SceneEditor::edit(std::string what, SceneChange change, std::string_view gesture) {
    const bool ends = std::exchange(endsWithNext_, false);
    Result<void> done = makeStep(std::move(what), std::move(change), gesture);
    if (ends) endGesture();
    return done;
}

Result<void> SceneEditor::makeStep(std::string what, SceneChange change, std::string_view gesture) {
    if (changesNothing(change)) return {};
    PFVOX_CHECK(checkChange(change));
    redo_.clear();
    if (!joinsLast(change, gesture)) {
        undo_.push_back({.what = std::move(what), .change = change});
        if (undo_.size() > kMaxUndoSteps) undo_.erase(undo_.begin());
        gesture_ = gesture;
    }
    changeTo(change);
    return {};
}

void SceneEditor::changeTo(const SceneChange& change) {
    apply(change, scene_);
    if (const auto* model = std::get_if<ModelChange>(&change)) {
        selected_ = model->after ? std::optional(model->index) : std::nullopt;
    }
    touched();
}

Result<void> SceneEditor::addModel(SceneModel model) {
    if (scene_.models.size() >= Limits{}.maxModels)
        return fail(ErrorCode::LimitExceeded, "the scene has as many models as a scene file may have");
    std::string what = fmt::format("add '{}'", labelOf(model));
    return edit(std::move(what),
                ModelChange{.index = scene_.models.size(), .before = {}, .after = std::move(model)});
}

Result<void> SceneEditor::duplicateModel(std::size_t index, const glm::dvec3& shiftMetres) {
    if (index >= scene_.models.size()) return fail(ErrorCode::BadReference, "there is no such model");
    if (scene_.models.size() >= Limits{}.maxModels)
        return fail(ErrorCode::LimitExceeded, "the scene has as many models as a scene file may have");
    SceneModel copy = scene_.models[index];
    copy.translateMetres += shiftMetres;
    std::string what = fmt::format("duplicate '{}'", labelOf(copy));
    return edit(std::move(what), ModelChange{.index = index + 1, .before = {}, .after = std::move(copy)});
}

Result<void> SceneEditor::removeModel(std::size_t index) {
    if (index >= scene_.models.size()) return fail(ErrorCode::BadReference, "there is no such model");
    const SceneModel& model = scene_.models[index];
    return edit(fmt::format("remove '{}'", labelOf(model)),
                ModelChange{.index = index, .before = model, .after = {}});
}

Result<void> SceneEditor::setModel(std::size_t index, SceneModel model, std::string_view gesture) {
    if (index >= scene_.models.size()) return fail(ErrorCode::BadReference, "there is no such model");
    const SceneModel& before = scene_.models[index];
    std::string what = whatOf(before, model);
    return edit(std::move(what), ModelChange{.index = index, .before = before, .after = std::move(model)},
                gesture);
}

Result<void> SceneEditor::setSun(const Sun& sun, std::string_view gesture) {
    return edit("sun", PartChange<Sun>{.before = scene_.sun, .after = sun}, gesture);
}

Result<void> SceneEditor::setSky(const Sky& sky, std::string_view gesture) {
    return edit("sky", PartChange<Sky>{.before = scene_.sky, .after = sky}, gesture);
}

Result<void> SceneEditor::setProbes(const ProbeGridRequest& probes, std::string_view gesture) {
    return edit("probe grid", PartChange<ProbeGridRequest>{.before = scene_.probes, .after = probes},
                gesture);
}

Result<void> SceneEditor::setCameras(std::vector<Camera> cameras, std::string_view gesture) {
    return edit("cameras",
                PartChange<std::vector<Camera>>{.before = scene_.cameras, .after = std::move(cameras)},
                gesture);
}

bool SceneEditor::undo() {
    if (undo_.empty()) return false;
    endGesture();
    Step step = std::move(undo_.back());
    undo_.pop_back();
    changeTo(reversed(step.change));
    redo_.push_back(std::move(step));
    return true;
}

bool SceneEditor::redo() {
    if (redo_.empty()) return false;
    endGesture();
    Step step = std::move(redo_.back());
    redo_.pop_back();
    changeTo(step.change);
    undo_.push_back(std::move(step));
    return true;
}

// ---- Files -----------------------------------------------------------------------------------------------

fs::path SceneEditor::fileOf(const SceneModel& model) const {
    return absolutePath(folder_ / fs::path(model.path));
}

std::string SceneEditor::pathOf(const fs::path& modelFile) const {
    return pathFrom(folder_, modelFile);
}

Result<void> SceneEditor::save() {
    if (file_.empty())
        return fail(ErrorCode::FileNotWritable, "the scene has no file yet: save it under a name");
    PFVOX_CHECK(writeScene(file_, scene_));
    saved_ = scene_;
    endGesture();
    changed_ = false;
    return {};
}

Result<void> SceneEditor::saveAs(const fs::path& file) {
    const fs::path folder = file.parent_path();
    // Without a file there was no good place to count from: its absolute paths are nobody's wish.
    const bool isFirst = file_.empty();
    const auto rebased = [&](const std::string& path) {
        const bool keeps = fs::path(path).is_absolute() && !isFirst;
        return keeps ? path : pathFrom(folder, folder_ / fs::path(path));
    };
    Scene scene = scene_;
    const bool moves = isFirst || absolutePath(folder / ".") != absolutePath(folder_ / ".");
    if (moves) {
        for (SceneModel& model : scene.models) model.path = rebased(model.path);
    }
    PFVOX_CHECK(writeScene(file, scene));
    if (moves) {
        for (std::vector<Step>* const steps : {&undo_, &redo_}) {
            for (Step& step : *steps) replacePaths(step.change, rebased);
        }
    }
    scene_ = std::move(scene);
    saved_ = scene_;
    file_ = file;
    folder_ = folder;
    endGesture();
    touched();
    return {};
}

}  // namespace pfvox::viewer
