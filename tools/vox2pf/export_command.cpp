#include <fmt/format.h>

#include <memory>
#include <pfvox/export.hpp>
#include <pfvox/files.hpp>
#include <pfvox/pf_vox.hpp>
#include <set>

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
        .examples = {{"vox2pf export hall.pf_vox -o hall.vox", "one file"},
                     {"vox2pf export hall.pf_vox -o hall.vdb", "as OpenVDB grids: density, Cd and material"},
                     {"vox2pf export build/assets --format vdb -o back",
                      "every PF_VOX file of a folder, into one folder"}}};
}

/// Whether a path that is to be a folder was rather meant as a file of a kind that nobody writes.
bool looksLikeOtherFile(const ExportOptions& options) {
    namespace fs = std::filesystem;
    std::error_code error;
    const fs::path output = options.output;
    if (fs::exists(output, error)) return !fs::is_directory(output, error);
    const bool oneFile = options.inputs.size() == 1 && !fs::is_directory(options.inputs.front(), error);
    return oneFile && output.has_filename() && output.has_extension();
}

/// A name that ends in .vox or .vdb is the file itself, anything else a folder for files of the sources'
/// names. What is wrong, when name and format contradict each other.
tl::expected<Target, std::string> targetOf(const ExportOptions& options) {
    Target target{.output = options.output, .format = options.format};
    const std::string extension = target.output.extension().string();
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

std::filesystem::path outputFor(const std::filesystem::path& source, const Target& target) {
    if (target.isFile) return target.output;
    return (target.output / source.filename()).replace_extension(target.format);
}

Result<std::uint64_t> exportFile(const std::filesystem::path& source, const Target& target,
                                 const Limits& limits, Diagnostics& diagnostics) {
    PFVOX_TRY(const OctreeAsset, asset, loadPfVox(source, limits, diagnostics));
    auto bytes =
        target.format == kVdb ? exportVdb(asset, limits, diagnostics) : exportVox(asset, diagnostics);
    if (!bytes) {
        bytes.error().file = source;
        return tl::make_unexpected(std::move(bytes).error());
    }
    PFVOX_CHECK(io::writeFileAtomically(outputFor(source, target), *bytes));
    return bytes->size();
}

}  // namespace

Command makeExportCommand(CLI::App& tool) {
    auto options = std::make_shared<ExportOptions>();
    CLI::App& command = addCommand(tool, "export", helpText());
    addReadOptions(command, *options, kPfVoxExtension);
    command.add_option("-o,--output", options->output, "the .vox or .vdb file, or a folder for several")
        ->option_text("PATH")
        ->required()
        ->check(suggestFiles({".vox", ".vdb"}))
        ->group(group::kInputOutput);
    command.add_option("--format", options->format, "vox or vdb")
        ->option_text("NAME")
        ->check(showDefault(fmt::format("as the output is named, in a folder {}", kVox)))
        ->check(CLI::IsMember({kVox, kVdb}))
        ->group(group::kInputOutput);

    const auto run = [&command, options] {
        const auto target = targetOf(*options);
        if (!target) return usageError(command, target.error());
        std::set<std::filesystem::path> written;
        const auto visit = [&](const std::filesystem::path& file, const Limits& limits,
                               Reporter& reporter) -> std::optional<ErrorCode> {
            const std::filesystem::path output = outputFor(file, *target);
            DiagnosticList diagnostics;
            auto bytes = written.insert(output).second
                             ? exportFile(file, *target, limits, diagnostics)
                             : Result<std::uint64_t>(tl::make_unexpected(Error{
                                   .code = ErrorCode::FileNotWritable,
                                   .message = fmt::format("{} was just written from another input; export "
                                                          "it to another folder",
                                                          output.string()),
                                   .file = file}));
            reporter.diagnostics(file, diagnostics.entries());
            if (!bytes) {
                reporter.error(withRemedy(bytes.error()));
                return bytes.error().code;
            }
            reporter.result(fmt::format("{} -> {}: {}\n", escaped(file.string()), escaped(output.string()),
                                        formatBytes(*bytes)));
            return std::nullopt;
        };
        return visitPfVoxFiles(command, *options, visit);
    };
    return {.app = &command, .run = run};
}

}  // namespace pfvox::tools
