// Command table: what a tool's CLI11 app declares, as plain data. Help pages, man pages and completion are
// written from it and from nothing else, so an option that was added stands in all of them.
#pragma once

#include <string>
#include <vector>

#include "common/help_page.hpp"

namespace pfvox::tools {

/// An option, or the arguments without a name.
struct OptionRow {
    std::vector<std::string> names;  ///< "-o", "--output"; empty for arguments
    std::string value;               ///< what its value is called, "PATH"; empty for flags
    std::string meaning;             ///< with the default behind it
    std::string defaultText;  ///< what holds without the option, showDefault(); empty = nothing to tell
    std::string group;
    std::vector<std::string> words;     ///< values to suggest
    bool isFile = false;                ///< the value is a file or folder
    std::vector<std::string> suffixes;  ///< of these files; empty = folders only

    bool operator==(const OptionRow&) const = default;
};

struct CommandTable {
    std::string name;
    HelpText text;
    std::vector<OptionRow> options;  ///< group by group, the general ones last; without hidden ones
    std::vector<OptionRow> arguments;
    std::vector<ExitCodeText> exitCodes;
    std::vector<CommandTable> commands;
};

CommandTable commandTable(const CLI::App& app);

/// "-o, --output PATH"; the long name stands in one column whether there is a short one or not.
std::string signatureOf(const OptionRow& option);

/// The options that all commands have in common, word for word.
std::vector<OptionRow> commonOptions(const CommandTable& tool);

/// What can be typed after the tool's name: its commands, or the tool itself when it has none.
std::vector<const CommandTable*> chooseable(const CommandTable& tool);
/// The one of them that needs no name.
const CommandTable& defaultOf(const CommandTable& tool);

}  // namespace pfvox::tools
