// The documents of the project, for the tests that read them.
#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

namespace pfvox::test {

inline const std::filesystem::path kProjectDir = std::filesystem::path(PFVOX_TESTS_DIR).parent_path();

/// README.md, CONTRIBUTING.md and the like, docs/**/*.md, examples/**/*.md, data/*.md; relative, sorted.
inline std::vector<std::filesystem::path> documents() {
    namespace fs = std::filesystem;
    std::vector<fs::path> files;
    const auto take = [&](const fs::path& file) {
        if (file.extension() == ".md") files.push_back(file.lexically_relative(kProjectDir));
    };
    for (const auto& entry : fs::directory_iterator(kProjectDir)) take(entry.path());
    for (const char* const folder : {"docs", "examples", "data"}) {
        if (!fs::exists(kProjectDir / folder)) continue;
        for (const auto& entry : fs::recursive_directory_iterator(kProjectDir / folder)) take(entry.path());
    }
    std::ranges::sort(files);
    return files;
}

}  // namespace pfvox::test
