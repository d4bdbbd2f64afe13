#include <memory>
#include <pfvox/files.hpp>

#include "common/file_visit.hpp"
#include "vox2pf/commands.hpp"
#include "vox2pf/info_report.hpp"
#include "vox2pf/pf_vox_inputs.hpp"

namespace pfvox::tools {

namespace {

HelpText helpText() {
    return {.summary = "Tells what is in PF_VOX files: models, instances, materials, sections and sizes.",
            .usage = {"vox2pf info [options] <file.pf_vox | folder | @list | ->..."},
            .examples = {{"vox2pf info hall.pf_vox", "tables for people"},
                         {"vox2pf info -v hall.pf_vox", "every model and instance"},
                         {"vox2pf info --json hall.pf_vox", "one JSON object a file"}}};
}

Result<FileInfo> readInfo(const std::filesystem::path& file, const Limits& limits,
                          DiagnosticList& diagnostics) {
    PFVOX_TRY(const io::FileBytes, contents, io::readFile(file, limits.maxFileBytes));
    PFVOX_TRY(PfVoxHeader, header, readPfVoxHeader(contents.bytes()));
    PFVOX_TRY(OctreeAsset, asset, decodePfVox(contents.bytes(), limits, diagnostics));
    return makeFileInfo(file, std::move(header), std::move(asset));
}

}  // namespace

Command makeInfoCommand(CLI::App& tool) {
    auto options = std::make_shared<ReadOptions>();
    CLI::App& command = addCommand(tool, "info", helpText());
    addReadOptions(command, *options, kPfVoxExtension);

    auto visit = [options, first = true](const std::filesystem::path& file, const Limits& limits,
                                         Reporter& reporter) mutable -> std::optional<ErrorCode> {
        DiagnosticList diagnostics;
        auto info = readInfo(file, limits, diagnostics);
        reporter.diagnostics(file, diagnostics.entries());
        if (!info) {
            if (info.error().file.empty()) info.error().file = file;
            return reportFailure(reporter, file, withRemedy(std::move(info).error()));
        }
        if (options->common.json) reporter.jsonLine(jsonText(infoJson(*info)));
        reporter.result((first ? "" : "\n") + infoText(*info, reporter, options->common.verbose));
        first = false;
        return std::nullopt;
    };
    return {.app = &command, .run = [&command, options, visit] {
                return visitFiles(command, *options, kPfVoxExtension, visit);
            }};
}

}  // namespace pfvox::tools
