#include <fmt/format.h>

#include "common/completion.hpp"
#include "common/completion_parts.hpp"

namespace pfvox::tools {

namespace {

/// With a backslash before what has a meaning in a spec of _arguments or _describe.
std::string inSpec(const std::string& text) {
    std::string result;
    for (const char c : text) {
        if (c == '[' || c == ']' || c == ':' || c == '\\') result += '\\';
        result += c;
    }
    return result;
}

/// What completes a value: ":PATH:_files -g ...".
std::string valueSpec(const OptionRow& row) {
    if (row.value.empty()) return {};
    std::string action = " ";  // nothing to suggest
    if (row.isFile && row.suffixes.empty()) {
        action = "_files -/";
    } else if (row.isFile) {
        // Of one suffix without parentheses: "(*.x)" would be a glob qualifier.
        const std::string glob = fmt::format("*{}", fmt::join(row.suffixes, "|*"));
        action = fmt::format("_files -g \"{}\"", row.suffixes.size() == 1 ? glob : "(" + glob + ")");
    } else if (!row.words.empty()) {
        action = fmt::format("({})", fmt::join(row.words, " "));
    }
    return ":" + inSpec(row.value) + ":" + action;
}

/// One line for each spelling; a spelling excludes none of the others, since several options may be given
/// again.
std::string optionSpecs(const OptionRow& option) {
    std::string lines;
    for (const std::string& name : option.names) {
        const char* const joint = option.value.empty() ? "" : name.starts_with("--") ? "=" : "+";
        const std::string spec =
            fmt::format("*{}{}[{}]{}", name, joint, inSpec(option.meaning), valueSpec(option));
        lines += " \\\n    " + singleQuoted(spec);
    }
    return lines;
}

std::string commandFunction(const std::string& name, const CommandTable& command) {
    std::string text = fmt::format("{}_{}() {{\n  _arguments -S", name, command.name);
    for (const OptionRow& option : command.options) text += optionSpecs(option);
    for (const OptionRow& argument : command.arguments)
        text += " \\\n    " + singleQuoted("*" + valueSpec(argument));
    return text + "\n}\n\n";
}

constexpr const char* kChoice = R"({name}() {{
  local -a commands
  commands=({rows}
  )
  if ((CURRENT == 2)); then
    _describe -t commands command commands
    [[ $words[2] == -* ]] && compadd -- {options}
    {name}_{defaultCommand}
    return
  fi
  case $words[2] in
    {commands})
      local command=$words[2]
      shift words
      ((CURRENT--))
      {name}_$command
      ;;
    *) {name}_{defaultCommand} ;;
  esac
}}

{name} "$@"
)";

}  // namespace

std::string zshCompletion(const CommandTable& tool) {
    const std::string name = functionName(tool);
    std::string text = fmt::format("#compdef {0}\n# Made by `{0} --generate zsh`.\n\n", tool.name);
    for (const CommandTable* command : chooseable(tool)) text += commandFunction(name, *command);
    if (tool.commands.empty()) return text + fmt::format("{}_{} \"$@\"\n", name, tool.name);
    std::string rows;
    for (const CommandTable& command : tool.commands)
        rows += "\n    " + singleQuoted(inSpec(command.name) + ":" + inSpec(command.text.summary));
    return text + fmt::format(fmt::runtime(kChoice), fmt::arg("name", name), fmt::arg("rows", rows),
                              fmt::arg("options", fmt::join(allNames(tool), " ")),
                              fmt::arg("defaultCommand", defaultOf(tool).name),
                              fmt::arg("commands", fmt::join(commandNames(tool), " | ")));
}

}  // namespace pfvox::tools
