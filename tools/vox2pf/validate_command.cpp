#include <fmt/format.h>

#include <memory>
#include <pfvox/files.hpp>
#include <pfvox/pf_vox.hpp>

#include "common/json.hpp"
#include "common/text.hpp"
#include "vox2pf/commands.hpp"
#include "vox2pf/pf_vox_inputs.hpp"

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

Json findingsJson(const std::filesystem::path& file, const std::vector<Finding>& findings) {
    Json list = Json::array();
    for (const Finding& finding : findings) {
        Json json;
        json["id"] = finding.id;
        json["context"] = finding.context;
        json["offsetBytes"] = finding.offsetBytes ? Json(*finding.offsetBytes) : Json(nullptr);
        json["message"] = finding.message;
        list.push_back(json);
    }
    Json json;
    json["file"] = file.string();
    json["valid"] = findings.empty();
    json["findings"] = list;
    return json;
}

std::string findingsText(const std::filesystem::path& file, const std::vector<Finding>& findings,
                         const Reporter& reporter) {
    using Style = Reporter::Style;
    if (findings.empty())
        return fmt::format("{}: {}\n", file.string(), reporter.styled(Style::Good, "valid"));
    std::string text;
    for (const Finding& finding : findings) {
        const std::string offset = finding.offsetBytes ? fmt::format("@0x{:x}", *finding.offsetBytes) : "";
        const bool both = !finding.context.empty() && !offset.empty();
        const std::string place = finding.context + (both ? " " : "") + offset;
        text += fmt::format("{}: {}{}{} [{}]\n", file.string(), place, place.empty() ? "" : ": ",
                            finding.message, finding.id);
    }
    return text + fmt::format("{}: {}\n", file.string(),
                              reporter.styled(Style::Bad, plural(findings.size(), "finding")));
}

}  // namespace

Command makeValidateCommand(CLI::App& tool) {
    auto options = std::make_shared<ReadOptions>();
    CLI::App& command = addCommand(tool, "validate", helpText());
    addReadOptions(command, *options);

    const auto run = [&command, options] {
        bool anyFinding = false;
        const auto visit = [&](const std::filesystem::path& file, const Limits& limits,
                               Reporter& reporter) -> std::optional<ErrorCode> {
            const auto contents = io::readFile(file, limits.maxFileBytes);
            if (!contents) {
                reporter.error(contents.error());
                return contents.error().code;
            }
            const std::vector<Finding> findings = validatePfVox(contents->bytes(), limits);
            if (options->common.json) reporter.jsonLine(jsonText(findingsJson(file, findings)));
            reporter.result(findingsText(file, findings, reporter));
            anyFinding = anyFinding || !findings.empty();
            return std::nullopt;
        };
        const ExitCode exitCode = visitPfVoxFiles(command, *options, visit);
        return anyFinding ? ExitCode::InvalidInput : exitCode;
    };
    return {.app = &command, .run = run};
}

}  // namespace pfvox::tools
