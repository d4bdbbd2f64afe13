#include "compose/scene_change.hpp"

#include <utility>

namespace pfvox::viewer {

namespace {

Sun& partOf(Scene& scene, const Sun&) {
    return scene.sun;
}
Sky& partOf(Scene& scene, const Sky&) {
    return scene.sky;
}
ProbeGridRequest& partOf(Scene& scene, const ProbeGridRequest&) {
    return scene.probes;
}
std::vector<Camera>& partOf(Scene& scene, const std::vector<Camera>&) {
    return scene.cameras;
}

void applyOne(const ModelChange& change, Scene& scene) {
    const auto at = scene.models.begin() + static_cast<std::ptrdiff_t>(change.index);
    if (!change.before) {
        scene.models.insert(at, *change.after);
    } else if (!change.after) {
        scene.models.erase(at);
    } else {
        *at = *change.after;
    }
}

template <class T>
void applyOne(const PartChange<T>& change, Scene& scene) {
    partOf(scene, change.after) = change.after;
}

std::optional<SceneChange> joinedOnes(const ModelChange& earlier, const ModelChange& later) {
    if (earlier.index != later.index || !earlier.after || !later.before || !later.after) return std::nullopt;
    return ModelChange{.index = earlier.index, .before = earlier.before, .after = later.after};
}

template <class T>
std::optional<SceneChange> joinedOnes(const PartChange<T>& earlier, const PartChange<T>& later) {
    return PartChange<T>{.before = earlier.before, .after = later.after};
}

template <class T, class U>
std::optional<SceneChange> joinedOnes(const T&, const U&) {
    return std::nullopt;
}

}  // namespace

void apply(const SceneChange& change, Scene& scene) {
    std::visit([&](const auto& one) { applyOne(one, scene); }, change);
}

SceneChange reversed(SceneChange change) {
    std::visit([](auto& one) { std::swap(one.before, one.after); }, change);
    return change;
}

std::optional<SceneChange> joined(const SceneChange& earlier, const SceneChange& later) {
    return std::visit([](const auto& a, const auto& b) { return joinedOnes(a, b); }, earlier, later);
}

bool changesNothing(const SceneChange& change) {
    return std::visit([](const auto& one) { return one.before == one.after; }, change);
}

void replacePaths(SceneChange& change, const std::function<std::string(const std::string&)>& newPath) {
    ModelChange* const model = std::get_if<ModelChange>(&change);
    if (model == nullptr) return;
    if (model->before) model->before->path = newPath(model->before->path);
    if (model->after) model->after->path = newPath(model->after->path);
}

Result<void> checkChange(const SceneChange& change) {
    Scene scene;
    if (const auto* model = std::get_if<ModelChange>(&change)) {
        if (!model->after) return {};
        scene.models.push_back(*model->after);
    } else {
        apply(change, scene);
    }
    DiagnosticList ignored;
    const Result<Scene> read = parseScene(sceneText(scene), {}, Limits{}, ignored);
    if (!read) return fail(read.error().code, read.error().message);
    if (*read != scene) return fail(ErrorCode::BadValue, "a scene file cannot hold this");
    return {};
}

}  // namespace pfvox::viewer
