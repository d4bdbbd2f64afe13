// The text of a scene as a Scene and the places of its model paths: what reader, loader and path rewriting
// share.
#pragma once

#include <pfvox/scene.hpp>

#include "scene/toml_nesting.hpp"

namespace pfvox::scene {

struct PathPlace {
    TextPlace begin;  ///< of the opening quote
    TextPlace end;    ///< behind the closing one
    std::string text() const;
};

struct ParsedScene {
    Scene scene;
    std::vector<PathPlace> paths;  ///< one for each of scene.models
};

/// Errors and diagnostics: those of pfvox::parseScene.
Result<ParsedScene> parseWithPlaces(std::string_view text, const std::filesystem::path& file,
                                    const Limits& limits, Diagnostics& diagnostics);

/// The same for a file.
Result<ParsedScene> readWithPlaces(const std::filesystem::path& file, const Limits& limits,
                                   Diagnostics& diagnostics);

}  // namespace pfvox::scene
