#include <memory>
#include <pfvox/files.hpp>
#include <pfvox/probe_file.hpp>

#include "common/file_visit.hpp"
#include "common/findings.hpp"
#include "probe-bake/commands.hpp"

namespace pfvox::tools {

namespace {

HelpText helpText() {
    return {
        .summary =
            "Checks PF_PROBE files, every map of every probe, and prints all findings. Exit code 4 if there "
            "is any.",
        .usage = {"probe-bake validate [options] <file.pf_probe | folder | @list | ->..."},
        .examples = {
            {"probe-bake validate hall.pf_probe", "one file"},
            {"probe-bake validate --json build", "one JSON object for every PF_PROBE file of a folder"}}};
}

}  // namespace

Command makeValidateCommand(CLI::App& tool) {
    auto options = std::make_shared<ReadOptions>();
    CLI::App& command = addCommand(tool, "validate", helpText());
    addReadOptions(command, *options, kPfProbeExtension);

    const auto run = [&command, options] {
        bool anyFinding = false;
        const auto visit = [&](const std::filesystem::path& file, const Limits& limits,
                               Reporter& reporter) -> std::optional<ErrorCode> {
            if (const auto readable = io::checkReadable(file, limits.maxFileBytes); !readable)
                return reportFailure(reporter, file, readable.error());
            const std::vector<Finding> findings = validatePfProbeFile(file, limits);
            if (options->common.json) reporter.jsonLine(jsonText(findingsJson(file, findings)));
            reporter.result(findingsText(file, findings, reporter));
            anyFinding = anyFinding || !findings.empty();
            return std::nullopt;
        };
        const ExitCode exitCode = visitFiles(command, *options, kPfProbeExtension, visit);
        return anyFinding ? ExitCode::InvalidInput : exitCode;
    };
    return {.app = &command, .run = run};
}

}  // namespace pfvox::tools
