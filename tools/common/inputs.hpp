// Inputs: from the words of a command line to the list of files that they stand for.
//
// A word is a file, a folder (searched with its subfolders), @list (a text file with one file or folder a
// line) or - (such a list on stdin). Files are taken whatever their name; folders give the files that a
// predicate picks, in sorted order. An input is a place: named twice it is taken once, but of two links to
// one file each is an input.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <pfvox/error.hpp>
#include <string>
#include <vector>

namespace pfvox::tools {

/// What the command line says about inputs.
struct InputWords {
    std::vector<std::string> words;
    bool nullSeparated = false;  ///< entries of lists end in NUL, as `find -print0` writes them
};

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

/// What folders hold and is left out is reported (macos-metadata: files "._x" that macOS writes beside x;
/// linked-folder). Errors: FileNotFound and FileNotReadable for a list; BadValue for an entry that is no
/// path; NothingToConvert for a folder or list without any input.
Result<std::vector<InputFile>> collectInputs(const InputWords& inputs, const InputQuery& query,
                                             Diagnostics& diagnostics);

}  // namespace pfvox::tools
