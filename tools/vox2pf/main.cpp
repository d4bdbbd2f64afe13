// vox2pf: converts voxel sources to PF_VOX files, and tells what is in such files.

#include <fmt/format.h>

#include <array>
#include <pfvox/import.hpp>
#include <pfvox/pf_vox.hpp>

#include "common/program.hpp"
#include "vox2pf/commands.hpp"

namespace pfvox::tools {

namespace {

std::string versionText() {
    std::string text = fmt::format("vox2pf {}\nreads   ", PFVOX_VERSION);
    const char* separator = "";
    for (const SourceFormat& format : sourceFormats()) {
        text += fmt::format("{}{} ({})", separator, format.extension, format.title);
        separator = ", ";
    }
    return text + fmt::format("\nwrites  {} (PF_VOX {}.{})", kPfVoxExtension, kPfVoxVersionMajor,
                              kPfVoxVersionMinor);
}

HelpText helpText() {
    return {
        .summary =
            "vox2pf converts voxel models to PF_VOX, the octree format of pfvox, and inspects such files.",
        .usage = {"vox2pf [convert] [options] <file | folder | @list | ->... -o <file | folder>",
                  "vox2pf info [options] <file.pf_vox>...", "vox2pf validate [options] <file.pf_vox>...",
                  "vox2pf export [options] <file.pf_vox>... -o <file.vox | file.vdb | folder>"},
        .examples = {{"vox2pf hall.vox -o hall.pf_vox", "convert one file"},
                     {"vox2pf assets -o build/assets", "convert a folder, keeping its tree"},
                     {"vox2pf info hall.pf_vox", "what is in it"}},
        .defaultCommand = "convert",
        .details = {
            "Results go to stdout, messages to stderr. An output appears complete or not at all: a failure, "
            "Ctrl-C or a termination signal leaves the previous one.",
            "What is up to date by its content is left alone; time stamps are never read. The same input "
            "gives the same bytes for any number of threads."}};
}

ExitCode run(int argc, char** argv) {
    const auto tool = makeTool("vox2pf", helpText(), versionText());
    tool->require_subcommand(1);
    const std::array commands{makeConvertCommand(*tool), makeInfoCommand(*tool), makeValidateCommand(*tool),
                              makeExportCommand(*tool)};
    if (const auto exitCode = parseCommandLine(*tool, withDefaultCommand(*tool, argc, argv))) {
        return *exitCode;
    }
    for (const Command& command : commands) {
        if (tool->got_subcommand(command.app)) return command.run();
    }
    return ExitCode::Internal;
}

}  // namespace

}  // namespace pfvox::tools

int main(int argc, char** argv) {
    return pfvox::tools::runProgram([&] { return pfvox::tools::run(argc, argv); });
}
