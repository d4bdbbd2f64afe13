// What the tests of man pages, completion and reference compare with: the help pages of the programs.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "support/process.hpp"
#include "support/temp_folder.hpp"

namespace pfvox::test {

/// A tool, or one of its commands.
struct ToolCommand {
    std::string tool;
    std::string command;  ///< empty = the tool itself
};

inline void PrintTo(const ToolCommand& it, std::ostream* out) {
    *out << it.tool << ' ' << it.command;
}

inline std::string help(const ToolCommand& it) {
    std::vector<std::string> arguments{std::string(PFVOX_TOOLS_DIR) + "/" + it.tool};
    if (!it.command.empty()) arguments.push_back(it.command);
    arguments.push_back("--help");
    const ProcessResult result = runProcess(arguments, {});
    EXPECT_EQ(result.exitCode, 0) << it.tool << ' ' << it.command;
    return result.out;
}

/// The lines between a heading and the next empty line.
inline std::vector<std::string> linesUnder(const std::string& text, const std::string& heading) {
    std::istringstream in(text);
    std::vector<std::string> lines;
    bool inside = false;
    for (std::string line; std::getline(in, line);) {
        if (line.starts_with(heading)) {
            inside = true;
        } else if (inside && line.empty()) {
            break;
        } else if (inside) {
            lines.push_back(line);
        }
    }
    return lines;
}

/// "-o", "--output": every spelling of every option in a help page.
inline std::set<std::string> optionsIn(const std::string& page) {
    static const std::regex kRow(R"(^ {2,6}((-\w|--[\w-]+)(, --[\w-]+)*))");
    std::set<std::string> names;
    std::istringstream in(page);
    for (std::string line; std::getline(in, line);) {
        std::smatch row;
        if (!std::regex_search(line, row, kRow)) continue;
        std::istringstream words(row[1].str());
        for (std::string word; std::getline(words, word, ',');) names.insert(word.substr(word.find('-')));
    }
    return names;
}

/// An option in a help page.
struct HelpRow {
    std::string option;  ///< by its first long name: "--filter", "--jobs"
    std::string line;
    std::string shown;  ///< the default; empty = none
};

inline std::vector<HelpRow> helpRows(const ToolCommand& it) {
    static const std::regex kOption(R"(^ {2,6}(-\w, )?(--[a-z][\w-]*))");
    static const std::regex kDefault(R"( \(default: (.*)\)$)");
    std::vector<HelpRow> found;
    std::istringstream in(help(it));
    for (std::string line; std::getline(in, line);) {
        std::smatch option;
        if (!std::regex_search(line, option, kOption)) continue;
        std::smatch shown;
        const bool hasDefault = std::regex_search(line, shown, kDefault);
        found.push_back({option[2], line, hasDefault ? shown[1].str() : std::string()});
    }
    return found;
}

/// The commands that a help page lists.
inline std::vector<std::string> commandsIn(const std::string& page) {
    std::vector<std::string> names;
    for (const std::string& line : linesUnder(page, "Commands (")) {
        const std::size_t begin = line.find_first_not_of(' ');
        names.push_back(line.substr(begin, line.find(' ', begin) - begin));
    }
    return names;
}

inline std::vector<std::string> builtTools() {
    std::vector<std::string> tools;
    for (const char* const tool : {"vox2pf", "probe-bake", "pfview"}) {
        if (std::string(PFVOX_BUILT_TOOLS).find(tool) != std::string::npos) tools.emplace_back(tool);
    }
    return tools;
}

/// Every tool and every command of it.
inline std::vector<ToolCommand> everyCommand() {
    std::vector<ToolCommand> all;
    for (const std::string& tool : builtTools()) {
        all.push_back({tool, {}});
        for (const std::string& command : commandsIn(help({tool, {}}))) all.push_back({tool, command});
    }
    return all;
}

/// Runs a program that PATH finds.
inline ProcessResult runInstalled(std::vector<std::string> arguments, const ProcessSetup& setup = {}) {
    arguments.insert(arguments.begin(), "/usr/bin/env");
    return runProcess(std::move(arguments), setup);
}

/// Whether a program can be run here.
inline bool isInstalled(const std::string& program) {
    return runInstalled({"sh", "-c", "command -v " + program}).exitCode == 0;
}

}  // namespace pfvox::test
