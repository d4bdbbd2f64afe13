#include <memory>
#include <pfvox/files.hpp>
#include <pfvox/pf_vox.hpp>

#include "common/file_visit.hpp"
#include "common/findings.hpp"
#include "vox2pf/commands.hpp"

namespace pfvox::tools {

namespace {

HelpText helpText() {
    return {
        .summary =
            "Checks PF_VOX files and prints every finding, not only the first. Exit code 4 if there is any.",
        .usage = {"vox2pf validate [options] <file.pf_vox | folder | @list | ->..."},
        .examples = {{"vox2pf validate hall.pf_vox", "one file"},
                     {"vox2pf validate build/assets", "every PF_VOX file of a folder"},
                     {"vox2pf validate --json hall.pf_vox", "one JSON object a file"}}};
}

}  // namespace

Command makeValidateCommand(CLI::App& tool) {
    auto options = std::make_shared<ReadOptions>();
    CLI::App& command = addCommand(tool, "validate", helpText());
    addReadOptions(command, *options, kPfVoxExtension);

    const auto run = [&command, options] {
        bool anyFinding = false;
        const auto visit = [&](const std::filesystem::path& file, const Limits& limits,
                               Reporter& reporter) -> std::optional<ErrorCode> {
            const auto contents = io::readFile(file, limits.maxFileBytes);
            if (!contents) return reportFailure(reporter, file, contents.error());
            const std::vector<Finding> findings = validatePfVox(contents->bytes(), limits);
            if (options->common.json) reporter.jsonLine(jsonText(findingsJson(file, findings)));
            reporter.result(findingsText(file, findings, reporter));
            anyFinding = anyFinding || !findings.empty();
            return std::nullopt;
        };
        const ExitCode exitCode = visitFiles(command, *options, kPfVoxExtension, visit);
        return anyFinding ? ExitCode::InvalidInput : exitCode;
    };
    return {.app = &command, .run = run};
}

}  // namespace pfvox::tools
