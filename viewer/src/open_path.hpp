// OpenPath: from what a user names or drops to the file that is shown.
#pragma once

#include <filesystem>
#include <pfvox/error.hpp>
#include <pfvox/scene.hpp>
#include <vector>

namespace pfvox::viewer {

struct OpenPath {
    std::filesystem::path file;                   ///< a scene or a PF_VOX file
    std::vector<std::filesystem::path> siblings;  ///< files to go through, sorted, `file` among them
    std::filesystem::path probes = {};            ///< named instead of its scene; else empty
};

/// A file stands for itself, a .pf_probe file for the scene or .pf_vox file beside it. A folder gives its
/// scenes (*.toml that have models) and PF_VOX files, scenes first. Errors: FileNotFound (also of probes
/// without a scene beside them), NothingToConvert (a folder without such files; says how to make one).
Result<OpenPath> openPath(const std::filesystem::path& path);

/// `step` files further in the list, beginning anew at its end.
std::filesystem::path neighborOf(const OpenPath& open, int step);

/// Whether this is a PF_VOX file alone, with nothing added to it: such a model stands on a ground.
bool isSingleModel(const std::filesystem::path& file, const Scene& scene);

/// The files that a scene was read from: itself and its models.
std::vector<std::filesystem::path> filesOf(const std::filesystem::path& file, const Scene& scene);

}  // namespace pfvox::viewer
