// Inputs: from the words of a command line to the list of files that they stand for.
//
// A word is a file, a folder (searched with its subfolders), @list (a text file with one word a line) or -
// (such a list on stdin). Files are taken whatever their name; folders give the files that a predicate picks,
// in sorted order.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <pfvox/error.hpp>
#include <string>
#include <vector>

namespace pfvox::tools {

struct InputFile {
    std::filesystem::path file;  ///< as it can be opened
    std::filesystem::path
        relative;  ///< below the folder that was named; the bare file name where a file was named
    bool fromFolder = false;
    std::optional<Error> fault =
        {};  ///< a folder that cannot be searched: an input that fails, so that others go on
};

struct InputQuery {
    std::function<bool(const std::filesystem::path&)> wanted;  ///< which files of a folder are inputs
    std::filesystem::path skippedFolder;  ///< a folder that is not searched; may be empty
};

/// What folders hold and is left out is noted (macos-metadata: files "._x" that macOS writes beside x;
/// linked-folder). Errors: FileNotFound for a list; NothingToConvert for a folder or list without any input.
Result<std::vector<InputFile>> collectInputs(const std::vector<std::string>& words, const InputQuery& query,
                                             Diagnostics& diagnostics);

/// The path as everyone on this machine would spell it: absolute and without "." and "..".
std::filesystem::path canonicalName(const std::filesystem::path& path);

}  // namespace pfvox::tools
