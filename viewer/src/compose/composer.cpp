#include "compose/composer.hpp"

#include <utility>

namespace pfvox::viewer {

namespace fs = std::filesystem;

void Composer::begin(const fs::path& file, const LoadedScene& loaded) {
    const bool isScene = file.extension() == ".toml";
    editor.reset(loaded.scene, isScene ? file : fs::path{}, file.parent_path());
    shelf_.clear();
    for (const PlacedAsset& part : loaded.parts)
        shelf_.put(editor.fileOf(loaded.scene.models[part.model]), part.asset);
    bounds_ = loaded.bounds;
    given_ = editor.revision();
    failed_.reset();
    toAdd_.clear();
    readAnew_ = false;
}

void Composer::beginEmpty(const fs::path& folder) {
    editor.reset({}, {}, folder);
    shelf_.clear();
    bounds_ = {};
    given_.reset();
    failed_.reset();
    toAdd_.clear();
    readAnew_ = false;
}

// ---- Models ----------------------------------------------------------------------------------------------

void Composer::addModels(const std::vector<fs::path>& files) {
    for (const fs::path& file : files) {
        // As the editor will name it, so that a model that is there already is found.
        toAdd_.push_back(editor.fileOf({.path = editor.pathOf(file)}));
    }
}

void Composer::read(std::vector<fs::path> files, bool add) {
    reading_ = Background<std::vector<ReadModel>>([files = std::move(files), add](Diagnostics& said) {
        std::vector<ReadModel> models;
        for (const fs::path& file : files)
            models.push_back({.file = file, .asset = readModel(file, said), .add = add});
        return models;
    });
}

void Composer::insert(const fs::path& file, const OctreeAsset& asset) {
    const glm::dvec3 place = placeBeside(bounds_, asset);
    const SceneModel model{
        .path = editor.pathOf(file), .name = file.stem().string(), .translateMetres = place};
    const WorldBounds own = boundsOf(asset, worldFromAsset(model, asset));
    if (!own.empty()) {
        bounds_.include(own.min);
        bounds_.include(own.max);
    }
    tell(editor.addModel(model));
}

void Composer::takeRead() {
    std::optional<std::vector<ReadModel>> read = reading_.take(*log_);
    if (!read) return;
    for (ReadModel& model : *read) {
        if (!model.asset) {
            log_->addError(describe(model.asset.error()));
            if (!model.add) failed_ = editor.revision();
            continue;
        }
        shelf_.put(model.file, *model.asset);
        if (model.add) insert(model.file, **model.asset);
    }
}

std::optional<LoadedScene> Composer::update() {
    takeRead();
    if (reading_.isAtWork()) return std::nullopt;
    while (!toAdd_.empty()) {
        const fs::path file = toAdd_.front();
        toAdd_.pop_front();
        const auto known = shelf_.find(file);
        if (known == nullptr) {
            read({file}, true);
            return std::nullopt;
        }
        insert(file, *known);
    }
    if ((given_ == editor.revision() && !readAnew_) || failed_ == editor.revision()) return std::nullopt;
    std::vector<fs::path> missing = missingModels(editor, shelf_);
    if (!missing.empty()) {
        read(std::move(missing), false);
        return std::nullopt;
    }
    Result<LoadedScene> scene = arranged(editor, shelf_, *log_);
    if (!scene) {
        failed_ = editor.revision();
        log_->addError(describe(scene.error()));
        return std::nullopt;
    }
    given_ = editor.revision();
    readAnew_ = false;
    bounds_ = scene->bounds;
    return *std::move(scene);
}

void Composer::readAgain() {
    shelf_.clear();
    failed_.reset();
    readAnew_ = true;
}

void Composer::duplicateSelected(const LoadedScene& shown) {
    if (!editor.selected()) return;
    const WorldBounds box = boundsOfModel(shown, *editor.selected());
    const double width = box.empty() ? 0.0 : box.max.x - box.min.x;
    tell(editor.duplicateModel(*editor.selected(), {1.1 * width, 0.0, 0.0}));
}

void Composer::removeSelected() {
    if (editor.selected()) tell(editor.removeModel(*editor.selected()));
}

void Composer::tell(const Result<void>& edit) {
    if (!edit) log_->addError(describe(edit.error()));
}

// ---- Leaving and saving ----------------------------------------------------------------------------------

void Composer::leave(std::function<void()> action) {
    if (!editor.isChanged()) return action();
    asked_ = std::move(action);
    leavesAfterSave_ = false;
}

void Composer::answer(Answer answer) {
    if (!asked_) return;
    if (answer == Answer::Save) {
        leavesAfterSave_ = true;
        if (editor.file().empty()) {
            dialog = Dialog::SaveAs;  // the question waits for the name
        } else {
            save();
        }
        return;
    }
    const std::function<void()> action = std::exchange(asked_, nullptr);
    leavesAfterSave_ = false;
    if (answer == Answer::Discard) action();
}

void Composer::afterSave() {
    written_ = true;
    log_->dismissStrip();
    log_->add(MessageKind::Note, "wrote " + editor.file().string());
    if (!std::exchange(leavesAfterSave_, false)) return;
    if (const std::function<void()> action = std::exchange(asked_, nullptr)) action();
}

bool Composer::save() {
    if (editor.file().empty()) {
        dialog = Dialog::SaveAs;
        return false;
    }
    const Result<void> written = editor.save();
    written ? afterSave() : tell(written);
    return written.has_value();
}

bool Composer::saveAs(const fs::path& file) {
    fs::path named = file;
    if (named.extension() != ".toml") named += ".toml";
    const Result<void> written = editor.saveAs(named);
    written ? afterSave() : tell(written);
    return written.has_value();
}

}  // namespace pfvox::viewer
