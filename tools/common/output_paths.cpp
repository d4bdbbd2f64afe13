#include "common/output_paths.hpp"

#include <fmt/format.h>

#include <map>

#include "common/paths.hpp"

namespace pfvox::tools {

namespace fs = std::filesystem;

bool namesOutputFile(const fs::path& output, const std::string& extension) {
    std::error_code error;
    return hasExtension(output, extension) && !fs::is_directory(output, error);
}

namespace {

/// What is wrong with `output` for these inputs, if anything.
std::string complaintAbout(const std::vector<InputFile>& inputs, const fs::path& output,
                           const std::string& extension) {
    const bool severalAssets = inputs.size() != 1 || inputs.front().fromFolder;
    if (namesOutputFile(output, extension)) {
        if (!severalAssets) return {};
        return fmt::format("-o {} names one file, but the input is {}: name a folder", output.string(),
                           inputs.front().fromFolder ? "a folder" : "several files");
    }
    std::error_code error;
    if (fs::exists(output, error) && !fs::is_directory(output, error)) {
        return fmt::format("-o {} is a file, but no {} file: name one, or a folder", output.string(),
                           extension);
    }
    const bool looksLikeOtherFile =
        output.has_filename() && output.has_extension() && !fs::exists(output, error);
    if (looksLikeOtherFile && !severalAssets) {
        return fmt::format("-o {0} is neither a {1} file nor a folder that exists: write {0}{1} or {0}/",
                           output.string(), extension);
    }
    return {};
}

void refuse(InputOutput& pair, const InputFile& other) {
    if (pair.input.fault) return;
    pair.input.fault = Error{.code = ErrorCode::FileNotWritable,
                             .message = fmt::format("{} would become {}, too: rename one of them, or give it "
                                                    "another output folder",
                                                    other.file.string(), pair.output.string()),
                             .file = pair.input.file};
}

/// Collects pairs, and what stands in the way of two with one output.
class Pairing {
  public:
    void add(InputOutput pair) {
        const auto [known, isNew] = indexOfOutput_.emplace(canonicalName(pair.output), pairs_.size());
        if (!isNew) {
            InputOutput& first = pairs_[known->second];
            const bool sameSource = canonicalName(first.input.file) == canonicalName(pair.input.file);
            if (sameSource && placeOf(first.output) == placeOf(pair.output)) return;
            if (!sameSource) {
                refuse(pair, first.input);
                refuse(first, pair.input);
            }
        }
        pairs_.push_back(std::move(pair));
    }
    /// Nothing is to be written for it.
    void addFault(InputOutput pair) { pairs_.push_back(std::move(pair)); }

    std::vector<InputOutput> take() { return std::move(pairs_); }

  private:
    std::vector<InputOutput> pairs_;
    std::map<fs::path, std::size_t> indexOfOutput_;  ///< by what is written to
};

}  // namespace

tl::expected<std::vector<InputOutput>, std::string> pairOutputs(
    std::vector<InputFile> inputs, const fs::path& output, const std::string& extension,
    const std::function<bool(const InputFile&)>& keepsName) {
    if (std::string complaint = complaintAbout(inputs, output, extension); !complaint.empty()) {
        return tl::make_unexpected(std::move(complaint));
    }
    const bool toFile = namesOutputFile(output, extension);
    Pairing pairing;
    for (InputFile& input : inputs) {
        const bool keeps = keepsName && keepsName(input);
        if (keeps && toFile) {
            return tl::make_unexpected(
                fmt::format("-o {} names a {} file, but {} keeps its name: name a folder", output.string(),
                            extension, input.file.string()));
        }
        fs::path target = output / input.relative;
        if (!keeps) target = toFile ? output : target.replace_extension(extension);
        if (input.fault) {
            pairing.addFault({.input = std::move(input), .output = target});
        } else if (canonicalName(target) != canonicalName(input.file)) {
            pairing.add({.input = std::move(input), .output = target});
        } else if (!input.fromFolder) {
            return tl::make_unexpected(
                fmt::format("{} would be overwritten by its own output", input.file.string()));
        }
    }
    return pairing.take();
}

}  // namespace pfvox::tools
