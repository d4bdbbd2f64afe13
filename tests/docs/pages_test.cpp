// Man pages and completion: what the build made of them, beside the help pages.
#include "docs/tool_help.hpp"

namespace pfvox::test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::UnorderedElementsAre;

const std::filesystem::path kPages = PFVOX_TOOL_PAGES_DIR;

std::filesystem::path pageOf(const std::string& tool, const std::string& kind) {
    if (kind == "man") return kPages / (tool + ".1");
    if (kind == "bash") return kPages / "bash" / tool;
    if (kind == "zsh") return kPages / "zsh" / ("_" + tool);
    return kPages / "fish" / (tool + ".fish");
}

std::string page(const std::string& tool, const std::string& kind) {
    return readText(pageOf(tool, kind));
}

std::string withoutBackslashes(std::string text) {
    std::erase(text, '\\');
    return text;
}

/// The part of a text from `begin` to the next `end`, or to its end.
std::string partOf(const std::string& text, const std::string& begin, const std::string& end) {
    const std::size_t from = text.find(begin);
    return from == std::string::npos ? std::string()
                                     : text.substr(from, text.find(end, from + begin.size()) - from);
}

/// What a program says to the page; it must be content.
void expectClean(const std::vector<std::string>& arguments) {
    const ProcessResult result = runInstalled(arguments, {.environment = {"LC_ALL=C.UTF-8", "MANWIDTH=100"}});
    EXPECT_EQ(result.exitCode, 0) << arguments.back();
    EXPECT_THAT(result.err, IsEmpty()) << arguments.back();
    if (arguments.front() == "man") return;  // prints the page
    EXPECT_THAT(result.out, IsEmpty()) << arguments.back();
}

TEST(ToolPages, AreWhatTheProgramsWrite) {
    for (const std::string& tool : builtTools()) {
        for (const std::string kind : {"man", "bash", "zsh", "fish"}) {
            const ProcessResult result =
                runProcess({std::string(PFVOX_TOOLS_DIR) + "/" + tool, "--generate", kind}, {});
            EXPECT_EQ(result.exitCode, 0);
            EXPECT_EQ(result.out, page(tool, kind)) << tool << ' ' << kind;
        }
        EXPECT_EQ(runProcess({std::string(PFVOX_TOOLS_DIR) + "/" + tool, "--generate", "csh"}, {}).exitCode,
                  2);
        EXPECT_THAT(help({tool, {}}), Not(HasSubstr("--generate"))) << "it is for the build";
    }
}

TEST(ToolPages, NameEveryOptionOfTheHelpPages) {
    for (const ToolCommand& it : everyCommand()) {
        const std::set<std::string> options = optionsIn(help(it));
        ASSERT_THAT(options, Contains("--help"));
        const std::string man = withoutBackslashes(page(it.tool, "man"));
        const std::string own =
            it.command.empty() ? man : partOf(man, ".SS " + it.tool + " " + it.command, "\n.S");
        const std::string common = partOf(man, ".SH OPTIONS OF ALL COMMANDS", "\n.SH");
        const std::string function = "_" + (it.command.empty() ? it.tool : it.command) + "() {";
        const std::string bash =
            partOf(page(it.tool, "bash"), "    " + (it.command.empty() ? it.tool : it.command) + ")\n", ";;");
        const std::string zsh = partOf(page(it.tool, "zsh"), function, "\n}");
        for (const std::string& option : options) {
            const std::string tag = "fB" + option + "fR";
            EXPECT_TRUE(own.find(tag) != std::string::npos || common.find(tag) != std::string::npos)
                << option << " in the man page";
            const bool isLong = option.starts_with("--");
            EXPECT_THAT(page(it.tool, "fish"),
                        HasSubstr(isLong ? " -l " + option.substr(2) : " -s " + option.substr(1)));
            if (it.command.empty() && !commandsIn(help(it)).empty())
                continue;  // those of the tool itself: below
            EXPECT_THAT(bash + ' ', HasSubstr(' ' + option)) << it.command;
            EXPECT_THAT(zsh, HasSubstr("'*" + option)) << it.command;
        }
    }
}

TEST(ToolPages, ManPagesAreClean) {
    for (const std::string& tool : builtTools()) {
        const std::string file = pageOf(tool, "man").string();
        if (isInstalled("mandoc")) expectClean({"mandoc", "-Tlint", file});
        if (isInstalled("groff")) expectClean({"man", "--warnings", "-l", file});
        EXPECT_THAT(readText(file), HasSubstr(".SH EXIT STATUS"));
    }
    if (!isInstalled("mandoc") && !isInstalled("groff"))
        GTEST_SKIP() << "neither mandoc nor groff here (Debian: mandoc)";
}

TEST(ToolPages, ShellsCanReadTheirCompletion) {
    std::string absent;
    for (const std::string& tool : builtTools()) {
        expectClean({"bash", "-n", pageOf(tool, "bash").string()});
        for (const auto& [shell, flag] : {std::pair{"zsh", "-n"}, std::pair{"fish", "--no-execute"}}) {
            if (isInstalled(shell)) {
                expectClean({shell, flag, pageOf(tool, shell).string()});
            } else {
                absent = shell;
            }
        }
    }
    if (!absent.empty()) GTEST_SKIP() << "bash is content; no " << absent << " here";
}

/// A folder with files of all kinds, in which a shell completes command lines.
class Completion : public ::testing::Test {
  protected:
    void SetUp() override {
        std::filesystem::create_directories(folder / "assets");
        for (const char* const name :
             {"a.vox", "b b.pf_vox", "c.pf_probe", "scene.toml", "notes.txt", "d.png"})
            writeText(folder / name, "");
    }

    /// What bash offers for the last of these words.
    std::multiset<std::string> bash(const std::vector<std::string>& words) const {
        std::string name = "_" + words.front();
        std::ranges::replace(name, '-', '_');
        std::vector<std::string> arguments{
            "bash", "-uc",
            "source \"$0\"; COMP_WORDS=(\"$@\"); COMP_CWORD=$(($# - 1)); " + name +
                "; ((${#COMPREPLY[@]} == 0)) || printf '%s\\n' \"${COMPREPLY[@]}\"",
            pageOf(words.front(), "bash").string()};
        arguments.insert(arguments.end(), words.begin(), words.end());
        return linesOf(arguments);
    }
    std::multiset<std::string> fish(const std::string& line) const {
        return linesOf({"fish", "-c",
                        "source $argv[1]; complete -C $argv[2] | string replace -r '\\t.*' ''; true",
                        pageOf(line.substr(0, line.find(' ')), "fish").string(), line});
    }

    TempFolder folder;

  private:
    std::multiset<std::string> linesOf(const std::vector<std::string>& arguments) const {
        const ProcessResult result = runInstalled(
            arguments,
            {.environment = {"HOME=" + folder.path().string()}, .input = {}, .folder = folder.path()});
        EXPECT_EQ(result.exitCode, 0) << result.err;
        EXPECT_THAT(result.err, IsEmpty());
        std::istringstream in(result.out);
        std::multiset<std::string> lines;
        for (std::string line; std::getline(in, line);) lines.insert(line);
        return lines;
    }
};

TEST_F(Completion, BashOffersCommandsOptionsAndFilesOfTheRightKind) {
    const auto first = bash({"vox2pf", ""});
    for (const char* const word : {"convert", "info", "validate", "export", "assets", "a.vox", "scene.toml"})
        EXPECT_THAT(first, Contains(word));
    EXPECT_THAT(first, Not(Contains("notes.txt")));
    EXPECT_THAT(bash({"vox2pf", "--fo"}), UnorderedElementsAre("--force")) << "of the default command";
    EXPECT_THAT(bash({"vox2pf", "exp"}), UnorderedElementsAre("export"));
    EXPECT_THAT(bash({"vox2pf", "info", ""}), UnorderedElementsAre("assets", "b b.pf_vox"));
    EXPECT_THAT(bash({"vox2pf", "info", "--fo"}), IsEmpty()) << "info has no --force";
    EXPECT_THAT(bash({"vox2pf", "a.vox", "--settings", ""}), UnorderedElementsAre("assets", "scene.toml"));
    EXPECT_THAT(bash({"vox2pf", "convert", "a.vox", "--hol"}), UnorderedElementsAre("--hollow"));
    EXPECT_THAT(bash({"vox2pf", "convert", "a.vox", "--no-"}),
                UnorderedElementsAre("--no-hollow", "--no-merge", "--no-include-hidden", "--no-summary",
                                     "--no-lod", "--no-clobber"));
}

TEST_F(Completion, BashOffersValuesThatAreKnownWords) {
    EXPECT_THAT(bash({"vox2pf", "a.vox", "--profile", ""}), UnorderedElementsAre("packed", "resident"));
    EXPECT_THAT(bash({"vox2pf", "a.vox", "--color", "=", "al"}), UnorderedElementsAre("always"));
    EXPECT_THAT(bash({"vox2pf", "a.vox", "--color", "="}), UnorderedElementsAre("auto", "always", "never"));
    EXPECT_THAT(bash({"vox2pf", "a.vox", "--vdb-up", ""}), UnorderedElementsAre("y", "z"));
    EXPECT_THAT(bash({"vox2pf", "a.vox", "--frame", ""}), IsEmpty()) << "a number: nothing to guess";
}

TEST_F(Completion, BashKnowsTheOtherTools) {
    for (const std::string& tool : builtTools()) {
        if (tool == "pfview") {
            EXPECT_THAT(bash({"pfview", ""}),
                        UnorderedElementsAre("assets", "b b.pf_vox", "c.pf_probe", "scene.toml"));
            EXPECT_THAT(bash({"pfview", "scene.toml", "--screenshot", ""}),
                        UnorderedElementsAre("assets", "d.png"));
            EXPECT_THAT(bash({"pfview", "scene.toml", "--view", "nor"}), UnorderedElementsAre("normals"));
        } else if (tool == "probe-bake") {
            EXPECT_THAT(bash({"probe-bake", "verify", ""}),
                        UnorderedElementsAre("assets", "b b.pf_vox", "c.pf_probe", "scene.toml"));
            EXPECT_THAT(bash({"probe-bake", "verify", "-o", ""}), UnorderedElementsAre("assets"))
                << "a folder";
            EXPECT_THAT(bash({"probe-bake", "scene.toml", "--profile", "th"}),
                        UnorderedElementsAre("thesis"));
            EXPECT_THAT(bash({"probe-bake", "comp"}), UnorderedElementsAre("compare"));
        }
    }
}

TEST_F(Completion, FishOffersCommandsOptionsAndWords) {
    if (!isInstalled("fish")) GTEST_SKIP() << "no fish here (Debian: fish)";
    EXPECT_THAT(fish("vox2pf exp"), UnorderedElementsAre("export"));
    EXPECT_THAT(fish("vox2pf a.vox --profile "), UnorderedElementsAre("packed", "resident"));
    EXPECT_THAT(fish("vox2pf --forc"), UnorderedElementsAre("--force"));
    EXPECT_THAT(fish("vox2pf info --forc"), IsEmpty());
    EXPECT_THAT(fish("vox2pf info "), Contains("b b.pf_vox"));
}

TEST_F(Completion, ZshCompletesCommandsOptionsWordsAndFiles) {
    if (!isInstalled("zsh")) GTEST_SKIP() << "no zsh here (Debian: zsh)";
    const std::filesystem::path script = std::filesystem::path(PFVOX_TESTS_DIR) / "docs/zsh_completion.zsh";
    std::vector<std::string> arguments{
        "timeout", "60", "zsh", "-f", script.string(), (kPages / "zsh").string()};
    // What is wanted is more than what was typed: the terminal shows that, too.
    const std::vector<std::string> steps{
        "vox2pf exp",    "export",     "vox2pf info --js",         "--json",
        "vox2pf info b", "b.pf_vox",   "vox2pf a.vox --profile r", "resident",
        "vox2pf sc",     "scene.toml", "vox2pf a.vox --holl",      "--hollow"};
    arguments.insert(arguments.end(), steps.begin(), steps.end());
    const ProcessResult result =
        runInstalled(arguments, {.environment = {"TERM=dumb"}, .input = {}, .folder = folder.path()});
    EXPECT_EQ(result.exitCode, 0) << "it stopped after " << result.out << result.err;
}

}  // namespace
}  // namespace pfvox::test
