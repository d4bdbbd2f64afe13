#include <fmt/format.h>

#include <algorithm>

#include "scene/scene_parser.hpp"
#include "scene/toml_text.hpp"

namespace pfvox {

Result<Scene> parseScene(std::string_view text, const std::filesystem::path& file, const Limits& limits,
                         Diagnostics& diagnostics) {
    PFVOX_TRY(scene::ParsedScene, parsed, scene::parseWithPlaces(text, file, limits, diagnostics));
    return std::move(parsed.scene);
}

Result<Scene> readScene(const std::filesystem::path& file, const Limits& limits, Diagnostics& diagnostics) {
    PFVOX_TRY(scene::ParsedScene, parsed, scene::readWithPlaces(file, limits, diagnostics));
    return std::move(parsed.scene);
}

namespace {

/// In the quotes of `old`, where they can hold it.
std::string quotedLike(std::string_view old, std::string_view text) {
    const bool literal = old.starts_with('\'') && !old.starts_with("'''");
    const auto needsEscape = [](char c) {
        return c == '\'' || (static_cast<unsigned char>(c) < 0x20 && c != '\t') || c == 0x7f;
    };
    if (literal && std::ranges::none_of(text, needsEscape)) return fmt::format("'{}'", text);
    return scene::tomlString(text);
}

}  // namespace

Result<std::string> withModelPaths(std::string_view text, const std::filesystem::path& file,
                                   const Limits& limits, Diagnostics& diagnostics,
                                   const NewModelPath& newPath) {
    PFVOX_TRY(scene::ParsedScene, parsed, scene::parseWithPlaces(text, file, limits, diagnostics));
    struct Edit {
        scene::PathPlace place;
        std::string path;
    };
    std::vector<Edit> edits;
    for (std::size_t i = 0; i < parsed.paths.size(); ++i) {
        SceneModel& model = parsed.scene.models[i];
        const std::optional<std::string> path = newPath({.model = model, .place = parsed.paths[i].text()});
        if (!path || *path == model.path) continue;
        edits.push_back({parsed.paths[i], *path});
        model.path = *path;
    }
    // Models are in the order of the text, but nothing of TOML promises it.
    std::ranges::sort(edits, {}, [](const Edit& edit) { return edit.place.begin; });
    scene::PlaceFinder finder(text);
    std::string edited;
    std::size_t done = 0;
    for (const Edit& edit : edits) {
        const std::size_t begin = finder.find(edit.place.begin);
        const std::size_t end = finder.find(edit.place.end);
        if (begin >= end || end > text.size()) {
            return fail(ErrorCode::Internal, "the place of a path is not in the text");
        }
        edited += text.substr(done, begin - done);
        edited += quotedLike(text.substr(begin, end - begin), edit.path);
        done = end;
    }
    edited += text.substr(done);

    DiagnosticList ignored;  // were told for the text as it came
    const Result<Scene> again = parseScene(edited, file, limits, ignored);
    if (!again || *again != parsed.scene) {
        return fail(ErrorCode::Internal, "changing model paths changed something else");
    }
    return edited;
}

}  // namespace pfvox
