// FileList: what a dialog that chooses a file shows of a folder.
#pragma once

#include <filesystem>
#include <pfvox/error.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace pfvox::viewer {

struct FileList {
    std::filesystem::path folder;      ///< absolute
    std::vector<std::string> folders;  ///< names, sorted; hidden ones are left out
    std::vector<std::string> files;    ///< names, sorted, with one of the extensions
};

/// Errors: FileNotReadable.
Result<FileList> listFiles(const std::filesystem::path& folder, std::span<const std::string_view> extensions);

}  // namespace pfvox::viewer
