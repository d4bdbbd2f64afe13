#include "open_path.hpp"

#include <algorithm>
#include <system_error>

#include "shown_probes.hpp"

namespace pfvox::viewer {

namespace fs = std::filesystem;

namespace {

Result<std::vector<fs::path>> filesWith(const fs::path& folder, const char* extension) {
    std::vector<fs::path> files;
    std::error_code error;
    for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
        std::error_code ignored;
        if (at->path().extension() == extension && at->is_regular_file(ignored)) files.push_back(at->path());
    }
    if (error) {
        return tl::make_unexpected(
            Error{.code = ErrorCode::FileNotReadable, .message = error.message(), .file = folder});
    }
    std::ranges::sort(files);
    return files;
}

/// Other TOML files live in such folders too: settings of a conversion, for one.
bool isScene(const fs::path& file) {
    if (file.filename() == "scene.toml") return true;  // a broken one is to be told about
    DiagnosticList ignored;
    const Result<Scene> scene = readScene(file, Limits{}, ignored);
    return scene && !scene->models.empty();
}

}  // namespace

Result<OpenPath> openPath(const fs::path& path) {
    std::error_code error;
    if (!fs::exists(path, error)) {
        return tl::make_unexpected(Error{
            .code = ErrorCode::FileNotFound, .message = "there is no such file or folder", .file = path});
    }
    if (path.extension() == ".pf_probe") {
        PFVOX_TRY(const fs::path, scene, sceneBeside(path));
        return OpenPath{.file = scene, .siblings = {scene}, .probes = path};
    }
    if (!fs::is_directory(path, error)) return OpenPath{.file = path, .siblings = {path}};
    PFVOX_TRY(std::vector<fs::path>, files, filesWith(path, ".toml"));
    std::erase_if(files, [](const fs::path& file) { return !isScene(file); });
    PFVOX_TRY(const std::vector<fs::path>, models, filesWith(path, ".pf_vox"));
    files.insert(files.end(), models.begin(), models.end());
    if (files.empty()) {
        return tl::make_unexpected(
            Error{.code = ErrorCode::NothingToConvert,
                  .message = "the folder holds neither a scene nor a .pf_vox file; make some: "
                             "vox2pf <sources> -o <this folder>",
                  .file = path});
    }
    return OpenPath{.file = files.front(), .siblings = files};
}

fs::path neighborOf(const OpenPath& open, int step) {
    const auto count = static_cast<int>(open.siblings.size());
    if (count == 0) return open.file;
    const auto found = std::ranges::find(open.siblings, open.file);
    const auto at = found == open.siblings.end() ? 0 : static_cast<int>(found - open.siblings.begin());
    return open.siblings[static_cast<std::size_t>(((at + step) % count + count) % count)];
}

bool isSingleModel(const fs::path& file, const Scene& scene) {
    return file.extension() == ".pf_vox" && scene.models.size() <= 1;
}

std::vector<fs::path> filesOf(const fs::path& file, const Scene& scene) {
    std::vector<fs::path> files{file};
    for (const SceneModel& model : scene.models) {
        files.push_back((file.parent_path() / fs::path(model.path)).lexically_normal());
    }
    return files;
}

}  // namespace pfvox::viewer
