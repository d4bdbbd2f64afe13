#include <fmt/format.h>

#include "common/completion.hpp"
#include "common/completion_parts.hpp"

namespace pfvox::tools {

namespace {

constexpr const char* kHead = R"(# fish completion of {tool}; made by `{tool} --generate fish`.

# Whether the command line is one of this command.
function __fish{name}_is
    set -l words (commandline -opc)
    set -l command {defaultCommand}
    if set -q words[2]; and contains -- $words[2] {commands}
        set command $words[2]
    end
    test $command = $argv[1]
end

complete -c {tool} -f
)";

/// Quotes in fish are closed by ' and know \' and \\ only.
std::string quoted(const std::string& text) {
    std::string word = "'";
    for (const char c : text) {
        if (c == '\'' || c == '\\') word += '\\';
        word += c;
    }
    return word + "'";
}

std::string suggestions(const OptionRow& row) {
    if (row.isFile && row.suffixes.empty()) return " -a '(__fish_complete_directories)'";
    if (row.isFile) return fmt::format(" -a '(__fish_complete_suffix {})'", fmt::join(row.suffixes, " "));
    if (!row.words.empty())
        return fmt::format(" -a {}", quoted(fmt::format("{}", fmt::join(row.words, " "))));
    return {};
}

std::string nameFlags(const OptionRow& option) {
    std::string flags;
    for (const std::string& name : option.names)
        flags += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
    return flags;
}

std::string optionLine(const CommandTable& tool, const std::string& condition, const OptionRow& option) {
    return fmt::format("complete -c {} -n {}{}{}{} -d {}\n", tool.name, quoted(condition), nameFlags(option),
                       option.value.empty() ? "" : " -x", suggestions(option), quoted(option.meaning));
}

}  // namespace

std::string fishCompletion(const CommandTable& tool) {
    const std::string name = functionName(tool);
    const std::string atFirst = "test (count (commandline -opc)) -eq 1";
    std::string text = fmt::format(fmt::runtime(kHead), fmt::arg("tool", tool.name), fmt::arg("name", name),
                                   fmt::arg("defaultCommand", defaultOf(tool).name),
                                   fmt::arg("commands", fmt::join(commandNames(tool), " ")));
    for (const CommandTable& command : tool.commands)
        text += fmt::format("complete -c {} -n {} -a {} -d {}\n", tool.name, quoted(atFirst), command.name,
                            quoted(command.text.summary));
    if (!tool.commands.empty()) {
        for (const OptionRow& option : tool.options) text += optionLine(tool, atFirst, option);
    }
    for (const CommandTable* command : chooseable(tool)) {
        const std::string condition = fmt::format("__fish{}_is {}", name, command->name);
        for (const OptionRow& option : command->options) text += optionLine(tool, condition, option);
        for (const OptionRow& argument : command->arguments) {
            if (argument.isFile)
                text += fmt::format("complete -c {} -n {}{}\n", tool.name, quoted(condition),
                                    suggestions(argument));
        }
    }
    return text;
}

}  // namespace pfvox::tools
