// docs/cli.md beside the help pages: every option and exit code stands there, and nothing that is gone.
#include "docs/tool_help.hpp"

namespace pfvox::test {
namespace {

using ::testing::ContainerEq;
using ::testing::Contains;
using ::testing::HasSubstr;

const std::string& reference() {
    static const std::string text = readText(std::filesystem::path(PFVOX_DOCS_DIR) / "cli.md");
    return text;
}

struct Section {
    std::string heading;
    std::string text;
};

std::vector<Section> sections() {
    std::vector<Section> all;
    std::istringstream in(reference());
    for (std::string line; std::getline(in, line);) {
        if (line.starts_with("## ")) {
            all.push_back({line.substr(3), {}});
        } else if (!all.empty()) {
            all.back().text += line + "\n";
        }
    }
    return all;
}

/// "probe-bake info, validate" is about `probe-bake validate`.
bool isAbout(const std::string& heading, const ToolCommand& it) {
    if (heading == "Options of all commands") return it.tool != "pfview";
    if (!heading.starts_with(it.tool)) return false;
    return it.command.empty() || std::regex_search(heading, std::regex("\\b" + it.command + "\\b"));
}

/// The options in code marks: `-o, --output PATH`, `--force`.
std::set<std::string> optionsNamedIn(const std::string& text) {
    static const std::regex kCode("`[^`\n]*`");
    static const std::regex kOption(R"((^|[\s`,=])(--[a-z][\w-]*|-[a-z0](?![\w-])))");
    std::set<std::string> names;
    for (std::sregex_iterator code(text.begin(), text.end(), kCode), end; code != end; ++code) {
        const std::string words = code->str();
        for (std::sregex_iterator option(words.begin(), words.end(), kOption); option != end; ++option)
            names.insert((*option)[2]);
    }
    return names;
}

TEST(CliReference, NamesEveryOptionOfEveryCommand) {
    for (const ToolCommand& it : everyCommand()) {
        if (it.command.empty() && it.tool != "pfview") continue;  // --help and --version only
        std::string text;
        for (const Section& section : sections()) {
            if (isAbout(section.heading, it)) text += section.text;
        }
        const std::set<std::string> named = optionsNamedIn(text);
        for (const std::string& option : optionsIn(help(it)))
            EXPECT_THAT(named, Contains(option)) << "of " << it.tool << ' ' << it.command;
    }
}

/// The rows of a table in which an option stands, without code marks.
std::string rowsOf(const std::string& text, const std::string& option) {
    std::string rows;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) {
        if (!line.starts_with("| `") || !optionsNamedIn(line.substr(0, line.find(" | "))).contains(option))
            continue;
        std::erase(line, '`');
        rows += line + "\n";
    }
    return rows;
}

TEST(CliReference, TellsTheDefaultsThatHelpShows) {
    for (const ToolCommand& it : everyCommand()) {
        if (it.command.empty() && it.tool != "pfview") continue;
        std::string text;
        for (const Section& section : sections()) {
            if (isAbout(section.heading, it)) text += section.text;
        }
        for (const HelpRow& row : helpRows(it)) {
            if (row.shown.empty()) continue;
            EXPECT_THAT(rowsOf(text, row.option), HasSubstr("default: " + row.shown))
                << "of " << it.tool << ' ' << it.command << ' ' << row.option;
        }
    }
}

TEST(CliReference, NamesNoOptionThatIsGone) {
    if (builtTools().size() < 3) GTEST_SKIP() << "built without the GPU: not all options are known";
    std::set<std::string> known{"--generate"};
    for (const ToolCommand& it : everyCommand()) known.merge(optionsIn(help(it)));
    for (const std::string& option : optionsNamedIn(reference())) EXPECT_THAT(known, Contains(option));
}

TEST(CliReference, ListsEveryCommand) {
    for (const ToolCommand& it : everyCommand()) {
        if (it.command.empty()) continue;
        EXPECT_TRUE(
            std::regex_search(reference(), std::regex("\n    " + it.tool + " \\[?" + it.command + "\\]? ")))
            << it.tool << ' ' << it.command;
    }
}

TEST(CliReference, ListsTheExitCodes) {
    std::set<std::string> listed;
    for (const Section& section : sections()) {
        static const std::regex kRow(R"(\n\| (\d+) \|)");
        if (section.heading != "Exit codes") continue;
        for (std::sregex_iterator row(section.text.begin(), section.text.end(), kRow), end; row != end; ++row)
            listed.insert((*row)[1]);
    }
    std::set<std::string> printed;
    for (const ToolCommand& it : everyCommand()) {
        for (const std::string& line : linesUnder(help(it), "Exit codes:")) {
            std::istringstream words(line);
            std::string code;
            words >> code;
            printed.insert(code);
        }
    }
    EXPECT_THAT(listed, ContainerEq(printed));
}

}  // namespace
}  // namespace pfvox::test
