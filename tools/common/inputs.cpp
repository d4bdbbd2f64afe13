#include "common/inputs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iostream>
#include <set>

#include "common/text.hpp"

namespace pfvox::tools {

namespace fs = std::filesystem;

namespace {

tl::unexpected<Error> failOn(ErrorCode code, const fs::path& file, std::string message) {
    return tl::make_unexpected(Error{.code = code, .message = std::move(message), .file = file});
}

std::vector<std::string> nonEmptyLines(std::istream& stream) {
    std::vector<std::string> lines;
    for (std::string line; std::getline(stream, line);) {
        if (line.ends_with('\r')) line.pop_back();
        if (!line.empty()) lines.push_back(line);
    }
    return lines;
}

class Collector {
  public:
    Collector(const InputQuery& query, Diagnostics& diagnostics) : query_(query), diagnostics_(diagnostics) {
        if (!query.skippedFolder.empty()) skipped_ = canonicalName(query.skippedFolder);
    }

    Result<void> addWord(const std::string& word) {
        if (word == "-") return addList("-", std::cin);
        if (word.size() > 1 && word.front() == '@') return addListFile(word.substr(1));
        return addPath(word);
    }

    std::vector<InputFile> take() { return std::move(files_); }

  private:
    Result<void> addListFile(const fs::path& file) {
        std::ifstream stream(file);
        if (!stream) return failOn(ErrorCode::FileNotFound, file, "cannot open this list of inputs");
        return addList(file, stream);
    }

    Result<void> addList(const fs::path& name, std::istream& stream) {
        const std::vector<std::string> lines = nonEmptyLines(stream);
        if (lines.empty()) return failOn(ErrorCode::NothingToConvert, name, "this list of inputs is empty");
        for (const std::string& line : lines) PFVOX_CHECK(addPath(line));
        return {};
    }

    Result<void> addPath(const fs::path& path) {
        std::error_code error;
        const fs::file_status status = fs::status(path, error);
        if (fs::is_directory(status)) return addFolder(path);
        // A file that is missing is an asset that fails, like one that is broken: the others go on.
        add({.file = path, .relative = path.filename(), .fromFolder = false});
        return {};
    }

    Result<void> addFolder(const fs::path& folder) {
        std::vector<InputFile> found;
        search(folder, folder, found);
        noteLeftOut(folder);
        if (found.empty())
            return failOn(ErrorCode::NothingToConvert, folder, "no input files in this folder");
        std::ranges::sort(found, {}, &InputFile::file);
        for (InputFile& input : found) add(std::move(input));
        return {};
    }

    /// Folder by folder, since recursive_directory_iterator does not tell in which one it failed.
    void search(const fs::path& folder, const fs::path& root, std::vector<InputFile>& found) {
        const auto inputAt = [&](const fs::path& path) {
            return InputFile{.file = path, .relative = path.lexically_relative(root), .fromFolder = true};
        };
        std::error_code error;
        auto entry = fs::directory_iterator(folder, error);
        for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
            std::error_code ignored;
            if (!entry->is_directory(ignored)) {
                if (isMacMetadata(entry->path())) {
                    ++macMetadata_;
                } else if (query_.wanted(entry->path()) && entry->is_regular_file(ignored)) {
                    found.push_back(inputAt(entry->path()));
                }
            } else if (entry->is_symlink(ignored)) {
                ++linkedFolders_;
            } else if (!isSkipped(entry->path())) {
                search(entry->path(), root, found);
            }
        }
        if (!error) return;
        found.push_back(inputAt(folder));
        found.back().fault = Error{.code = ErrorCode::FileNotReadable,
                                   .message = "cannot search this folder: " + error.message(),
                                   .file = folder};
    }

    /// Whether this stands beside a file that is wanted.
    bool isMacMetadata(const fs::path& file) const {
        const std::string name = file.filename().string();
        return name.starts_with("._") && query_.wanted(file.parent_path() / name.substr(2));
    }

    void noteLeftOut(const fs::path& folder) {
        if (macMetadata_ > 0) {
            diagnostics_.note("macos-metadata",
                              fmt::format("{}: {} that macOS keeps beside others (._*) left out",
                                          folder.string(), plural(macMetadata_, "file")));
        }
        if (linkedFolders_ > 0) {
            diagnostics_.warn("linked-folder",
                              fmt::format("{}: {} not searched: name what it leads to as an input, too",
                                          folder.string(), plural(linkedFolders_, "linked folder")));
        }
        macMetadata_ = linkedFolders_ = 0;
    }

    bool isSkipped(const fs::path& folder) const {
        return !skipped_.empty() && canonicalName(folder) == skipped_;
    }

    void add(InputFile input) {
        if (seen_.insert(canonicalName(input.file)).second) files_.push_back(std::move(input));
    }

    const InputQuery& query_;
    Diagnostics& diagnostics_;
    std::size_t macMetadata_ = 0;
    std::size_t linkedFolders_ = 0;
    fs::path skipped_;
    std::vector<InputFile> files_;
    std::set<fs::path> seen_;
};

}  // namespace

Result<std::vector<InputFile>> collectInputs(const std::vector<std::string>& words, const InputQuery& query,
                                             Diagnostics& diagnostics) {
    Collector collector(query, diagnostics);
    for (const std::string& word : words) PFVOX_CHECK(collector.addWord(word));
    return collector.take();
}

fs::path canonicalName(const fs::path& path) {
    std::error_code error;
    // Made absolute first: of a path that does not exist at all weakly_canonical leaves a relative one.
    const fs::path absolute = fs::absolute(path, error);
    fs::path name = fs::weakly_canonical(absolute, error);
    if (error) name = absolute.lexically_normal();
    return name.has_filename() ? name : name.parent_path();
}

}  // namespace pfvox::tools
