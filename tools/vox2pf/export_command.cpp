#include <fmt/format.h>

#include <map>
#include <memory>
#include <pfvox/export.hpp>
#include <pfvox/files.hpp>
#include <pfvox/pf_vox.hpp>

#include "common/file_visit.hpp"
#include "common/json.hpp"
#include "common/output_paths.hpp"
#include "common/paths.hpp"
#include "common/text.hpp"
#include "vox2pf/commands.hpp"
#include "vox2pf/pf_vox_inputs.hpp"

namespace pfvox::tools {

namespace {

constexpr const char* kVox = "vox";
constexpr const char* kVdb = "vdb";

struct ExportOptions : ReadOptions {
    std::string output;
    std::string format;
};

/// Where files go and what they become.
struct Target {
    std::filesystem::path output;
    std::string format;  ///< kVox or kVdb
    bool isFile = false;
};

HelpText helpText() {
    return {
        .summary =
            "Writes PF_VOX files back as MagicaVoxel or OpenVDB files, for round trips and for editing.",
        .usage = {"vox2pf export [options] <file.pf_vox | folder | @list | ->... -o <file.vox | file.vdb | "
                  "folder>"},
        .examples = {
            {"vox2pf export hall.pf_vox -o hall.vox", "one file"},
            {"vox2pf export hall.pf_vox -o hall.vdb", "as OpenVDB grids: density, Cd and material"},
            {"vox2pf export build/assets --format vdb -o back", "a folder with its subfolders, mirrored"}}};
}

/// Whether a path that is to be a folder was rather meant as a file of a kind that nobody writes.
bool looksLikeOtherFile(const ExportOptions& options) {
    namespace fs = std::filesystem;
    std::error_code error;
    const fs::path output = options.output;
    if (fs::exists(output, error)) return !fs::is_directory(output, error);
    const std::vector<std::string>& words = options.inputs.words;
    const bool oneFile = words.size() == 1 && !fs::is_directory(words.front(), error);
    return oneFile && output.has_filename() && output.has_extension();
}

/// A name that ends in .vox or .vdb is the file itself, anything else a folder for files of the sources'
/// names. What is wrong, when name and format contradict each other.
tl::expected<Target, std::string> targetOf(const ExportOptions& options) {
    Target target{.output = options.output, .format = options.format};
    const std::string extension = lowerCase(target.output.extension().string());
    target.isFile = extension == ".vox" || extension == ".vdb";
    if (!target.isFile && looksLikeOtherFile(options)) {
        return tl::make_unexpected(fmt::format(
            "-o {0} is neither a .vox or .vdb file nor a folder: name one of these, or write {0}/",
            options.output));
    }
    const std::string named = target.isFile ? extension.substr(1) : kVox;
    if (target.format.empty()) target.format = named;
    if (target.isFile && target.format != named) {
        return tl::make_unexpected(fmt::format("--format {} contradicts the name of the output, {}",
                                               options.format, options.output));
    }
    return target;
}

using Outputs = std::map<std::filesystem::path, std::filesystem::path>;

/// Decides where every input goes, and finds what stands in the way of each, before the first is written.
std::string planOutputs(std::vector<InputFile>& inputs, const Target& target, Outputs& outputs) {
    auto pairs = pairOutputs(std::move(inputs), target.output, "." + target.format);
    inputs.clear();
    if (!pairs) return pairs.error();
    for (InputOutput& pair : *pairs) {
        if (auto status = io::checkReplaceable(pair.output); !status && !pair.input.fault)
            pair.input.fault = std::move(status).error();
        outputs.emplace(pair.input.file, pair.output);
        inputs.push_back(std::move(pair.input));
    }
    return {};
}

Result<std::uint64_t> exportFile(const std::filesystem::path& source, const std::filesystem::path& output,
                                 const Limits& limits, Diagnostics& diagnostics) {
    PFVOX_TRY(const OctreeAsset, asset, loadPfVox(source, limits, diagnostics));
    auto bytes =
        hasExtension(output, ".vdb") ? exportVdb(asset, limits, diagnostics) : exportVox(asset, diagnostics);
    if (!bytes) {
        bytes.error().file = source;
        return tl::make_unexpected(std::move(bytes).error());
    }
    PFVOX_CHECK(io::writeFileAtomically(output, *bytes));
    return bytes->size();
}

ExitCode runExport(const CLI::App& command, const ExportOptions& options) {
    const auto target = targetOf(options);
    if (!target) return usageError(command, target.error());
    Outputs outputs;
    const auto plan = [&](std::vector<InputFile>& inputs) { return planOutputs(inputs, *target, outputs); };
    const auto visit = [&](const std::filesystem::path& file, const Limits& limits,
                           Reporter& reporter) -> std::optional<ErrorCode> {
        const std::filesystem::path& output = outputs.at(file);
        DiagnosticList diagnostics;
        const auto bytes = exportFile(file, output, limits, diagnostics);
        reporter.diagnostics(file, diagnostics.entries());
        if (!bytes) return reportFailure(reporter, file, withRemedy(bytes.error()));
        if (options.common.json) {
            reporter.jsonLine(jsonText(
                Json{{"file", file.string()}, {"output", output.string()}, {"outputBytes", *bytes}}));
        }
        reporter.result(fmt::format("{} -> {}: {}\n", escaped(file.string()), escaped(output.string()),
                                    formatBytes(*bytes)));
        return std::nullopt;
    };
    return visitFiles(command, options, kPfVoxExtension, visit, plan);
}

}  // namespace

Command makeExportCommand(CLI::App& tool) {
    auto options = std::make_shared<ExportOptions>();
    CLI::App& command = addCommand(tool, "export", helpText());
    addReadOptions(command, *options, kPfVoxExtension);
    command.add_option("-o,--output", options->output, "the .vox or .vdb file, or a folder for several")
        ->option_text("PATH")
        ->required()
        ->check(outputPath())
        ->check(suggestFiles({".vox", ".vdb"}))
        ->group(group::kInputOutput);
    command.add_option("--format", options->format, "vox or vdb")
        ->option_text("NAME")
        ->check(showDefault(fmt::format("as the output is named, in a folder {}", kVox)))
        ->check(CLI::IsMember({kVox, kVdb}))
        ->group(group::kInputOutput);

    return {.app = &command, .run = [&command, options] { return runExport(command, *options); }};
}

}  // namespace pfvox::tools
