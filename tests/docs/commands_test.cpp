// Every command that the documents show is run, in their order, with the built tools and the demo data; or it
// stands in excluded_commands.txt with the reason why not.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <regex>
#include <sstream>

#include "docs/documents.hpp"
#include "support/process.hpp"
#include "support/temp_folder.hpp"

namespace pfvox::test {
namespace {

namespace fs = std::filesystem;

struct DocCommand {
    std::string place;  ///< "README.md:17"
    std::string line;
};

/// In an indented block or a fence without a language a line is a command when it begins with one of our
/// programs or one that builds them.
bool looksLikeCommand(const std::string& line) {
    static const std::regex kStart(
        R"(^([A-Z_]+=\S* )*(\./)?(vox2pf|probe-bake|pfview|cmake|ctest|ninja|make|git|cd|sudo|apt-get|apt|export|sbatch|scontrol|man|mkdir|(scripts|bench|examples|build)/\S+)(\s.*)?$)");
    return std::regex_match(line, kStart);
}

std::string withoutComment(std::string line) {
    static const std::regex kComment(R"(\s+#.*$)");
    line = std::regex_replace(line, kComment, "");
    return line.substr(0, line.find_last_not_of(' ') + 1);
}

std::vector<DocCommand> commandsIn(const fs::path& document) {
    std::ifstream in(kProjectDir / document);
    std::vector<DocCommand> commands;
    std::string fence;
    bool inFence = false;
    int number = 0;
    for (std::string line; std::getline(in, line);) {
        ++number;
        if (line.starts_with("```")) {
            fence = inFence ? "" : line.substr(3);
            inFence = !inFence;
            continue;
        }
        if (!inFence && !line.starts_with("    ")) continue;
        std::string text = inFence ? line : line.substr(4);
        const bool hasPrompt = text.starts_with("$ ");
        if (hasPrompt) text.erase(0, 2);
        text = withoutComment(text);
        const bool isShell = fence == "sh" || fence == "bash" || fence == "shell";
        const bool isCommand = fence == "console" ? hasPrompt
                               : isShell          ? !text.empty() && text[0] != '#'
                                                  : fence.empty() && looksLikeCommand(text);
        if (isCommand) commands.push_back({document.generic_string() + ":" + std::to_string(number), text});
    }
    return commands;
}

struct Exclusion {
    std::string document;
    std::regex line;
    std::string text;
    bool isUsed = false;
};

std::vector<Exclusion> exclusions() {
    std::ifstream in(kProjectDir / "tests/docs/excluded_commands.txt");
    static const std::regex kRow(R"(^(\S+) \| (.*) \| (.+)$)");
    std::vector<Exclusion> all;
    for (std::string line; std::getline(in, line);) {
        std::smatch row;
        if (line.empty() || line[0] == '#') continue;
        if (!std::regex_match(line, row, kRow)) throw std::runtime_error("excluded_commands.txt: " + line);
        all.push_back({row[1], std::regex(row[2].str()), line});
    }
    return all;
}

/// A folder that looks like the project after scripts/demo, with a few files for the examples.
class Workplace {
  public:
    Workplace() {
        for (const char* const name : {"data", "examples"})
            fs::copy(kProjectDir / name, folder_ / name, fs::copy_options::recursive);
        // The demo scene with few probes: CI bakes on the CPU.
        std::string scene = readText(folder_ / "data/scene.toml");
        scene = std::regex_replace(scene, std::regex("probeGridStep = [^\n]*"), "probeGridStep = 6.0");
        scene =
            std::regex_replace(scene, std::regex("probeGridCount = [^\n]*"), "probeGridCount = [2, 2, 2]");
        writeText(folder_ / "data/scene.toml", scene);
        fs::copy_file(folder_ / "data/courtyard.vox", folder_ / "castle.vox");
        fs::create_directories(folder_ / "assets/props");
        fs::copy_file(folder_ / "data/lamp.vox", folder_ / "assets/lamp.vox");
        fs::copy_file(folder_ / "data/tree.vox", folder_ / "assets/props/tree.vox");
        addTools();
    }

    ProcessResult run(const std::string& line) const {
        const std::string path =
            "PATH=" + (folder_ / "build/release/bin").string() + ":/usr/local/bin:/usr/bin:/bin";
        return runProcess({"/usr/bin/env", path, "/bin/bash", "-euo", "pipefail", "-c", line},
                          {.environment = {}, .input = {}, .folder = folder_.path()});
    }

  private:
    void addTools() const {
        const fs::path bin = folder_ / "build/release/bin";
        fs::create_directories(bin);
        for (const auto& entry : fs::directory_iterator(PFVOX_TOOLS_DIR))
            fs::create_symlink(entry.path(), bin / entry.path().filename());
        if (!fs::exists(bin / "probe-bake")) return;
        // With small maps and few samples, for the same reason as above.
        fs::remove(bin / "probe-bake");
        writeText(bin / "probe-bake",
                  "#!/bin/sh\ncase \"$1\" in info|validate|compare|merge|verify) ;;\n"
                  "*) set -- \"$@\" --resolution 16,8,4,6 --samples 16 ;;\nesac\nexec " PFVOX_TOOLS_DIR
                  "/probe-bake \"$@\"\n");
        fs::permissions(bin / "probe-bake", fs::perms::owner_all);
    }

    TempFolder folder_;
};

TEST(DocumentCommands, AreRunOrExcludedWithAReason) {
    if (std::string_view(PFVOX_BUILT_TOOLS).find("pfview") == std::string_view::npos)
        GTEST_SKIP() << "built without the GPU: half of the commands cannot run";
    const Workplace workplace;
    ASSERT_EQ(workplace.run("vox2pf data -o build/demo").exitCode, 0);
    std::vector<Exclusion> excluded = exclusions();
    std::map<std::string, int> runs;
    for (const fs::path& document : documents()) {
        for (const DocCommand& command : commandsIn(document)) {
            const auto exclusion = std::ranges::find_if(excluded, [&](const Exclusion& candidate) {
                return candidate.document == document.generic_string() &&
                       std::regex_match(command.line, candidate.line);
            });
            if (exclusion != excluded.end()) {
                exclusion->isUsed = true;
                continue;
            }
            const ProcessResult result = workplace.run(command.line);
            EXPECT_EQ(result.exitCode, 0) << command.place << ": " << command.line << "\n"
                                          << result.out << result.err;
            ++runs[document.generic_string()];
        }
    }
    for (const Exclusion& exclusion : excluded)
        EXPECT_TRUE(exclusion.isUsed) << "no such command any more: " << exclusion.text;
    EXPECT_GE(runs["README.md"], 7) << "the reading of README.md is broken, or it lost its commands";
}

TEST(DocumentCommands, AreFoundInBlocksOfAllKinds) {
    const TempFolder folder;
    writeText(folder / "a.md",
              "Run vox2pf now:\n\n    vox2pf a.vox -o b   # why\n    some table\n\n```sh\nls x\n# no\n```\n\n"
              "```console\n$ pfview a\noutput\n```\n```toml\nvox2pf = 1\n```\n");
    std::vector<std::string> lines;
    for (const DocCommand& command : commandsIn(folder / "a.md")) lines.push_back(command.line);
    EXPECT_THAT(lines, ::testing::ElementsAre("vox2pf a.vox -o b", "ls x", "pfview a"));
}

}  // namespace
}  // namespace pfvox::test
