#include "common/output_paths.hpp"

#include <fmt/format.h>

#include <map>

namespace pfvox::tools {

namespace fs = std::filesystem;

bool namesOutputFile(const fs::path& output, const std::string& extension) {
    std::error_code error;
    return output.extension() == extension && !fs::is_directory(output, error);
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

}  // namespace

tl::expected<std::vector<InputOutput>, std::string> pairOutputs(
    std::vector<InputFile> inputs, const fs::path& output, const std::string& extension,
    const std::function<bool(const InputFile&)>& keepsName) {
    if (std::string complaint = complaintAbout(inputs, output, extension); !complaint.empty()) {
        return tl::make_unexpected(std::move(complaint));
    }
    const bool toFile = namesOutputFile(output, extension);
    std::vector<InputOutput> pairs;
    std::map<fs::path, fs::path> inputOfOutput;
    for (InputFile& input : inputs) {
        if (input.fault) {
            pairs.push_back({.input = input, .output = output / input.relative});
            continue;
        }
        const bool keeps = keepsName && keepsName(input);
        if (keeps && toFile) {
            return tl::make_unexpected(
                fmt::format("-o {} names a {} file, but {} keeps its name: name a folder", output.string(),
                            extension, input.file.string()));
        }
        fs::path target = output / input.relative;
        if (!keeps) target = toFile ? output : target.replace_extension(extension);
        const fs::path name = canonicalName(target);
        if (name == canonicalName(input.file)) {
            if (input.fromFolder) continue;
            return tl::make_unexpected(
                fmt::format("{} would be overwritten by its own output", input.file.string()));
        }
        const auto [other, isNew] = inputOfOutput.emplace(name, input.file);
        if (!isNew) {
            return tl::make_unexpected(fmt::format("{} and {} would both become {}", other->second.string(),
                                                   input.file.string(), target.string()));
        }
        pairs.push_back({.input = std::move(input), .output = target});
    }
    return pairs;
}

}  // namespace pfvox::tools
