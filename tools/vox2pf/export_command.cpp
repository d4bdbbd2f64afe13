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

constexpr const char* kVoxExtension = ".vox";

struct ExportOptions : ReadOptions {
    std::string output;
};

HelpText helpText() {
    return {.summary = "Writes PF_VOX files back as MagicaVoxel files, for round trips and for editing.",
            .usage = {"vox2pf export [options] <file.pf_vox | folder | @list | ->... -o <file.vox | folder>"},
            .examples = {{"vox2pf export hall.pf_vox -o hall.vox", "one file"},
                         {"vox2pf export build/assets -o back", "every PF_VOX file of a folder, into one folder"}}};
}

/// A name that ends in .vox is the file itself, anything else a folder for files of the sources' names.
std::filesystem::path outputFor(const std::filesystem::path& source, const std::filesystem::path& output) {
    if (output.extension() == kVoxExtension) return output;
    return (output / source.filename()).replace_extension(kVoxExtension);
}

Result<std::uint64_t> exportFile(const std::filesystem::path& source, const std::filesystem::path& output,
                                 const Limits& limits, Diagnostics& diagnostics) {
    PFVOX_TRY(const OctreeAsset, asset, loadPfVox(source, limits, diagnostics));
    auto bytes = exportVox(asset, diagnostics);
    if (!bytes) {
        bytes.error().file = source;
        return tl::make_unexpected(std::move(bytes).error());
    }
    PFVOX_CHECK(io::writeFileAtomically(output, *bytes));
    return bytes->size();
}

}  // namespace

Command makeExportCommand(CLI::App& tool) {
    auto options = std::make_shared<ExportOptions>();
    CLI::App& command = addCommand(tool, "export", helpText());
    addReadOptions(command, *options);
    command.add_option("-o,--output", options->output, "the .vox file, or a folder for several")
        ->option_text("PATH")
        ->required();

    const auto run = [&command, options] {
        std::set<std::filesystem::path> written;
        const auto visit = [&](const std::filesystem::path& file, const Limits& limits,
                               Reporter& reporter) -> std::optional<ErrorCode> {
            const std::filesystem::path output = outputFor(file, options->output);
            DiagnosticList diagnostics;
            auto bytes = written.insert(output).second
                             ? exportFile(file, output, limits, diagnostics)
                             : Result<std::uint64_t>(tl::make_unexpected(
                                   Error{.code = ErrorCode::FileNotWritable,
                                         .message = fmt::format("{} was just written from another input; export "
                                                                "it to another folder",
                                                                output.string()),
                                         .file = file}));
            reporter.diagnostics(file, diagnostics.entries());
            if (!bytes) {
                reporter.error(withRemedy(bytes.error()));
                return bytes.error().code;
            }
            reporter.result(fmt::format("{} -> {}: {}\n", file.string(), output.string(), formatBytes(*bytes)));
            return std::nullopt;
        };
        return visitPfVoxFiles(command, *options, visit);
    };
    return {.app = &command, .run = run};
}

}  // namespace pfvox::tools
