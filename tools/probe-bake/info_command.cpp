#include <memory>

#include "common/file_visit.hpp"
#include "probe-bake/commands.hpp"
#include "probe-bake/info_report.hpp"

namespace pfvox::tools {

namespace {

HelpText helpText() {
    return {.summary = "Tells what is in PF_PROBE files: grid, settings, layers, and what each probe sees.",
            .usage = {"probe-bake info [options] <file.pf_probe | folder | @list | ->..."},
            .examples = {{"probe-bake info hall.pf_probe", "tables for people"},
                         {"probe-bake info -v hall.pf_probe", "every probe"},
                         {"probe-bake info --json hall.pf_probe", "one JSON object a file"}}};
}

}  // namespace

Command makeInfoCommand(CLI::App& tool) {
    auto options = std::make_shared<ReadOptions>();
    CLI::App& command = addCommand(tool, "info", helpText());
    addReadOptions(command, *options, kPfProbeExtension);

    auto visit = [options, first = true](const std::filesystem::path& file, const Limits& limits,
                                         Reporter& reporter) mutable -> std::optional<ErrorCode> {
        DiagnosticList diagnostics;
        auto info = readProbeFileInfo(file, limits, diagnostics);
        reporter.diagnostics(file, diagnostics.entries());
        if (!info) return reportFailure(reporter, file, std::move(info).error());
        if (options->common.json) reporter.jsonLine(jsonText(infoJson(*info)));
        reporter.result((first ? "" : "\n") + infoText(*info, reporter, options->common.verbose));
        first = false;
        return std::nullopt;
    };
    return {.app = &command, .run = [&command, options, visit] {
                return visitFiles(command, *options, kPfProbeExtension, visit);
            }};
}

}  // namespace pfvox::tools
