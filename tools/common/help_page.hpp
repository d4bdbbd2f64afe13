// Help page: how a tool and its commands describe themselves. makeTool() and addCommand() make the CLI11 apps
// to which the options are added; what was added there is the one table of options, from which --help, man
// pages and completion come (command_table.hpp).
#pragma once

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "common/exit_code.hpp"

namespace pfvox::tools {

struct Example {
    std::string command;
    std::string meaning;
};

/// What a help page says beside the options.
struct HelpText {
    std::string summary;             ///< one sentence
    std::vector<std::string> usage;  ///< command lines; a line that begins with a space is a remark
    std::vector<Example> examples;
    std::string defaultCommand = {};        ///< of a tool: the command that need not be named
    std::vector<std::string> details = {};  ///< paragraphs for the man page
    std::vector<ExitCode> exitCodes = {};   ///< that can come; empty = all
};

/// The tool itself, without options but --help, --version and the hidden --generate man|bash|zsh|fish, which
/// prints the man page or the completion of a shell by way of CLI::CallForVersion.
std::unique_ptr<CLI::App> makeTool(const std::string& name, const HelpText& text, const std::string& version);

/// A subcommand of the tool.
CLI::App& addCommand(CLI::App& tool, const std::string& name, const HelpText& text);

/// What makeTool() or addCommand() was given; an empty text for other apps.
const HelpText& helpTextOf(const CLI::App& app);

/// For `check()` of an option or argument: lets everything pass and tells the completion that values are
/// files with these suffixes, or folders. No suffix: folders only.
CLI::Validator suggestFiles(const std::vector<std::string>& suffixes);
/// The same for words, where another check decides.
CLI::Validator suggestWords(const std::vector<std::string>& words);

/// For `check()` of an option: what holds when it is left out, which help, man page and completion then show.
/// Take it from the variable or the settings that hold it, never from a literal.
CLI::Validator showDefault(const std::string& text);
template <class Number>
requires std::is_arithmetic_v<Number> CLI::Validator showDefault(Number value) {
    return showDefault(fmt::format("{}", value));
}

}  // namespace pfvox::tools
