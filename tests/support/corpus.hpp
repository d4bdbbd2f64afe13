// The corpus: real files that others made, beside the project and not part of it.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

namespace pfvox::test {

/// Every file below the corpus folder `part` with this extension, sorted; empty where the corpus is absent.
inline std::vector<std::filesystem::path> corpusFiles(const std::string& part, const std::string& extension) {
    std::vector<std::filesystem::path> files;
    const std::filesystem::path root = std::filesystem::path(PFVOX_CORPUS_DIR) / part;
    std::error_code error;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root, error)) {
        if (entry.path().extension() == extension) files.push_back(entry.path());
    }
    std::ranges::sort(files);
    return files;
}

/// The .vox files of the corpus without those that the importer refuses (vox_corpus_test.cpp checks that it
/// does).
inline std::vector<std::filesystem::path> convertibleVoxFiles() {
    std::vector<std::filesystem::path> files = corpusFiles("vox", ".vox");
    std::erase_if(files, [](const std::filesystem::path& file) {
        const std::string name = file.filename().string();
        return name == "slab6_vox_test.vox" || name == "teardown.vox" || name == "not_a.vox";
    });
    return files;
}

}  // namespace pfvox::test

/// Skips the running test when a corpus file or folder is not there.
#define PFVOX_NEEDS_CORPUS(relative)                                                    \
    if (!std::filesystem::exists(std::filesystem::path(PFVOX_CORPUS_DIR) / (relative))) \
    GTEST_SKIP() << "corpus file absent: " << (relative) << " (set PFVOX_CORPUS_DIR to the corpus folder)"
