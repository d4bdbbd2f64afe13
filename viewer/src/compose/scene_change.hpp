// SceneChange: one step of editing a scene, as what was before and what is after: it can be taken back and
// done again.
#pragma once

#include <functional>
#include <optional>
#include <pfvox/scene.hpp>
#include <string>
#include <variant>
#include <vector>

namespace pfvox::viewer {

/// A model at a place of Scene::models. Without `before` it is inserted there, without `after` it is taken
/// out.
struct ModelChange {
    std::size_t index = 0;
    std::optional<SceneModel> before;
    std::optional<SceneModel> after;
};

/// A part of a scene that there is once.
template <class T>
struct PartChange {
    T before;
    T after;
};

using SceneChange = std::variant<ModelChange, PartChange<Sun>, PartChange<Sky>, PartChange<ProbeGridRequest>,
                                 PartChange<std::vector<Camera>>>;

/// Precondition: the scene is what the change was made for.
void apply(const SceneChange& change, Scene& scene);
/// apply(reversed(c)) after apply(c) leaves the scene as it was.
SceneChange reversed(SceneChange change);
/// Two changes of the same thing as one, the earlier first. Nothing when they do not belong together.
std::optional<SceneChange> joined(const SceneChange& earlier, const SceneChange& later);
bool changesNothing(const SceneChange& change);

/// Replaces the paths of the models on both sides.
void replacePaths(SceneChange& change, const std::function<std::string(const std::string&)>& newPath);

/// Whether a scene file can hold what the change brings: by the reader of scene files itself, so that there
/// is one set of rules. Errors: BadValue, LimitExceeded.
Result<void> checkChange(const SceneChange& change);

}  // namespace pfvox::viewer
