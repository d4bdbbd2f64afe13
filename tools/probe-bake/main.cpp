// probe-bake: bakes the light of a scene into PF_PROBE files, and tells what is in such files.

#include <fmt/format.h>

#include <array>
#include <pfvox/pf_probe.hpp>

#include "common/program.hpp"
#include "probe-bake/commands.hpp"

namespace pfvox::tools {

namespace {

std::string versionText() {
    return fmt::format(
        "probe-bake {}\nreads   scene.toml, PF_VOX {}.{}, PF_PROBE {}.{}\nwrites  {} (PF_PROBE {}.{})",
        PFVOX_VERSION, kPfVoxVersionMajor, kPfVoxVersionMinor, kPfProbeVersionMajor, kPfProbeVersionMinor,
        kPfProbeExtension, kPfProbeVersionMajor, kPfProbeVersionMinor);
}

HelpText helpText() {
    return {
        .summary =
            "probe-bake bakes the indirect light of a scene, on faces of voxels and in probes, and inspects "
            "such "
            "files.",
        .usage = {"probe-bake [bake] [options] <scene.toml | file.pf_vox> -o <file.pf_probe>",
                  "probe-bake info [options] <file.pf_probe>...",
                  "probe-bake validate [options] <file.pf_probe>...",
                  "probe-bake compare [options] <a.pf_probe> <b.pf_probe>",
                  "probe-bake merge [options] <shard.pf_probe>... -o <file.pf_probe>",
                  "probe-bake verify [options] <scene.toml | file.pf_vox> <file.pf_probe>"},
        .examples = {{"probe-bake scene.toml -o scene.pf_probe", "bake the scene"},
                     {"probe-bake info hall.pf_probe", "what is in it"}},
        .defaultCommand = "bake",
        .details = {
            "Results go to stdout, messages to stderr. An output appears complete or not at all. A bake that "
            "was stopped leaves its finished probes in a journal beside the output; --resume goes on from "
            "there.",
            "The same scene, settings and device give the same bytes, in one run or in shards that are "
            "merged."}};
}

ExitCode run(int argc, char** argv) {
    const auto tool = makeTool("probe-bake", helpText(), versionText());
    tool->require_subcommand(1);
    const std::array commands{makeBakeCommand(*tool),    makeInfoCommand(*tool),  makeValidateCommand(*tool),
                              makeCompareCommand(*tool), makeMergeCommand(*tool), makeVerifyCommand(*tool)};
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
