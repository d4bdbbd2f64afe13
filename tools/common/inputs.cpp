#include "common/inputs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iostream>
#include <set>

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
    explicit Collector(const InputQuery& query) : query_(query) {
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
        std::vector<fs::path> found;
        PFVOX_CHECK(search(folder, found));
        if (found.empty())
            return failOn(ErrorCode::NothingToConvert, folder, "no input files in this folder");
        std::ranges::sort(found);
        for (const fs::path& file : found) {
            add({.file = file, .relative = file.lexically_relative(folder), .fromFolder = true});
        }
        return {};
    }

    /// Folder by folder, since recursive_directory_iterator does not tell in which one it failed.
    Result<void> search(const fs::path& folder, std::vector<fs::path>& found) const {
        std::error_code error;
        auto entry = fs::directory_iterator(folder, error);
        for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
            std::error_code ignored;
            if (!entry->is_directory(ignored)) {
                if (query_.wanted(entry->path()) && entry->is_regular_file(ignored)) found.push_back(entry->path());
            } else if (!entry->is_symlink(ignored) && !isSkipped(entry->path())) {
                PFVOX_CHECK(search(entry->path(), found));
            }
        }
        if (!error) return {};
        return failOn(ErrorCode::FileNotReadable, folder, "cannot search this folder: " + error.message());
    }

    bool isSkipped(const fs::path& folder) const {
        return !skipped_.empty() && canonicalName(folder) == skipped_;
    }

    void add(InputFile input) {
        if (seen_.insert(canonicalName(input.file)).second) files_.push_back(std::move(input));
    }

    const InputQuery& query_;
    fs::path skipped_;
    std::vector<InputFile> files_;
    std::set<fs::path> seen_;
};

}  // namespace

Result<std::vector<InputFile>> collectInputs(const std::vector<std::string>& words, const InputQuery& query) {
    Collector collector(query);
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
