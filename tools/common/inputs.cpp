#include "common/inputs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <iterator>
#include <pfvox/files.hpp>
#include <set>
#include <string_view>

#include "common/paths.hpp"
#include "common/text.hpp"

namespace pfvox::tools {

namespace fs = std::filesystem;

namespace {

tl::unexpected<Error> failOn(ErrorCode code, const fs::path& file, std::string message) {
    return tl::make_unexpected(Error{.code = code, .message = std::move(message), .file = file});
}

constexpr std::uint64_t kMaxListBytes = std::uint64_t{1} << 30;

/// The entries of a list, empty ones left out. Lines may end as on Windows.
std::vector<std::string_view> entriesOf(std::string_view text, bool nullSeparated) {
    if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
    std::vector<std::string_view> entries;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find(nullSeparated ? '\0' : '\n'), text.size());
        std::string_view entry = text.substr(0, end);
        if (!nullSeparated && entry.ends_with('\r')) entry.remove_suffix(1);
        if (!entry.empty()) entries.push_back(entry);
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return entries;
}

/// What is wrong with the encoding of a list of lines, if anything.
std::string complaintAbout(std::string_view text) {
    if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff"))
        return "this list of inputs is UTF-16: save it as UTF-8";
    const std::size_t nul = text.find('\0');
    if (nul == std::string_view::npos) return {};
    return fmt::format(
        "line {} of this list of inputs has a NUL character: for what `find -print0` writes there is -0",
        1 + std::ranges::count(text.substr(0, nul), '\n'));
}

class Collector {
  public:
    Collector(bool nullSeparated, const InputQuery& query, Diagnostics& diagnostics)
        : nullSeparated_(nullSeparated), query_(query), diagnostics_(diagnostics) {
        if (!query.skippedFolder.empty()) skipped_ = canonicalName(query.skippedFolder);
    }

    Result<void> addWord(const std::string& word) {
        if (word == "-") return addList("-", std::string(std::istreambuf_iterator<char>(std::cin), {}));
        if (word.size() > 1 && word.front() == '@') return addListFile(word.substr(1));
        return addText(word);
    }

    std::vector<InputFile> take() { return std::move(files_); }

  private:
    Result<void> addListFile(const fs::path& file) {
        auto contents = io::readFile(file, kMaxListBytes);
        if (!contents) {
            contents.error().message += ": a list of inputs is a text file";
            if (isPresent("@" + file.string()))
                contents.error().message += "; the file of that name is ./@" + file.string();
            return tl::make_unexpected(std::move(contents).error());
        }
        const auto bytes = contents->bytes();
        return addList(file, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    }

    Result<void> addList(const fs::path& name, std::string_view text) {
        if (std::string complaint = nullSeparated_ ? std::string() : complaintAbout(text); !complaint.empty())
            return failOn(ErrorCode::BadValue, name, std::move(complaint));
        const std::vector<std::string_view> entries = entriesOf(text, nullSeparated_);
        if (entries.empty()) return failOn(ErrorCode::NothingToConvert, name, "this list of inputs is empty");
        for (const std::string_view entry : entries) PFVOX_CHECK(addText(entry));
        return {};
    }

    Result<void> addText(std::string_view text) {
        PFVOX_TRY(const fs::path, path, io::pathFromText(text));
        std::error_code error;
        const fs::file_status status = fs::status(path, error);
        if (fs::is_directory(status)) return addFolder(path);
        // A file that is missing is an asset that fails, like one that is broken: the others go on.
        add({.file = path, .relative = path.filename(), .fromFolder = false, .fault = missing(path)});
        return {};
    }

    /// What is wrong with a file that is not there and whose name somebody nearly hit.
    static std::optional<Error> missing(const fs::path& path) {
        const auto meant = nearlyNamed(path);
        if (!meant) return std::nullopt;
        return Error{.code = ErrorCode::FileNotFound,
                     .message = fmt::format("there is no such file; did you mean {}?", meant->string()),
                     .file = path};
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
                } else if (query_.wanted(entry->path())) {
                    addFile(*entry, inputAt(entry->path()), found);
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

    /// A link to nothing is an asset that fails, but for those that Emacs makes beside a file it edits.
    static void addFile(const fs::directory_entry& entry, InputFile input, std::vector<InputFile>& found) {
        std::error_code ignored;
        if (entry.is_symlink(ignored) && !entry.exists(ignored)) {
            if (input.file.filename().native().starts_with(".#")) return;
            input.fault = Error{.code = ErrorCode::FileNotFound,
                                .message =
                                    "a link that leads to no file: fetch what it stands for (git annex "
                                    "get, dvc pull), or remove it",
                                .file = input.file};
        } else if (!entry.is_regular_file(ignored)) {
            return;
        }
        found.push_back(std::move(input));
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
        if (seen_.insert(placeOf(input.file)).second) files_.push_back(std::move(input));
    }

    bool nullSeparated_;
    const InputQuery& query_;
    Diagnostics& diagnostics_;
    std::size_t macMetadata_ = 0;
    std::size_t linkedFolders_ = 0;
    fs::path skipped_;
    std::vector<InputFile> files_;
    std::set<fs::path> seen_;
};

}  // namespace

Result<std::vector<InputFile>> collectInputs(const InputWords& inputs, const InputQuery& query,
                                             Diagnostics& diagnostics) {
    Collector collector(inputs.nullSeparated, query, diagnostics);
    for (const std::string& word : inputs.words) PFVOX_CHECK(collector.addWord(word));
    return collector.take();
}

}  // namespace pfvox::tools
