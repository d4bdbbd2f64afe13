#include <fmt/format.h>

#include "common/completion.hpp"
#include "common/completion_parts.hpp"

namespace pfvox::tools {

namespace {

/// Functions are named after the tool; bash forbids '-' there in POSIX mode.
constexpr const char* kHead = R"(# bash completion of {tool}; made by `{tool} --generate bash`.

{name}_words() {{
  mapfile -t -O "${{#COMPREPLY[@]}}" COMPREPLY < <(compgen -W "$*" -- "$cur")
}}

# Folders, and files that end in one of the suffixes.
{name}_files() {{
  local suffix
  compopt -o filenames 2>/dev/null
  mapfile -t -O "${{#COMPREPLY[@]}}" COMPREPLY < <(compgen -d -- "$cur")
  for suffix in "$@"; do
    mapfile -t -O "${{#COMPREPLY[@]}}" COMPREPLY < <(compgen -f -X "!*$suffix" -- "$cur")
  done
}}

{name}() {{
  local cur=${{COMP_WORDS[COMP_CWORD]}} prev=${{COMP_WORDS[COMP_CWORD - 1]}} command={defaultCommand}
  COMPREPLY=()
  # --option=value arrives as three words.
  if [[ $cur == '=' ]]; then
    cur=
  elif [[ $prev == '=' ]]; then
    prev=${{COMP_WORDS[COMP_CWORD - 2]}}
  fi
)";

constexpr const char* kCommands = R"(  if ((COMP_CWORD == 1)); then
    {name}_words {words}
  else
    case ${{COMP_WORDS[1]}} in
      {commands}) command=${{COMP_WORDS[1]}} ;;
    esac
  fi
)";

std::string filesCall(const std::string& name, const OptionRow& row) {
    std::string call = name + "_files";
    for (const std::string& suffix : row.suffixes) call += " " + singleQuoted(suffix);
    return call;
}

std::string valueCases(const std::string& name, const CommandTable& command) {
    std::string text;
    for (const OptionRow& option : command.options) {
        if (option.value.empty()) continue;
        std::string pattern;
        for (const std::string& word : option.names)
            pattern += fmt::format("{}{}:{}", pattern.empty() ? "" : " | ", command.name, word);
        std::string action;
        if (option.isFile) action = filesCall(name, option) + "; ";
        if (!option.words.empty()) action += fmt::format("{}_words {}; ", name, fmt::join(option.words, " "));
        text += fmt::format("    {}) {}return ;;\n", pattern, action);
    }
    return text;
}

std::string optionCase(const std::string& name, const CommandTable& command) {
    std::string files = ":";
    for (const OptionRow& argument : command.arguments) {
        if (argument.isFile) files = filesCall(name, argument);
    }
    return fmt::format(
        "    {})\n      if [[ $cur == -* ]]; then\n        {}_words {}\n      else\n        {}\n      fi\n   "
        "   ;;\n",
        command.name, name, fmt::join(allNames(command), " "), files);
}

}  // namespace

std::string bashCompletion(const CommandTable& tool) {
    const std::string name = functionName(tool);
    const auto commands = chooseable(tool);
    std::string text = fmt::format(fmt::runtime(kHead), fmt::arg("tool", tool.name), fmt::arg("name", name),
                                   fmt::arg("defaultCommand", defaultOf(tool).name));
    if (!tool.commands.empty()) {
        const std::vector<std::string> names = commandNames(tool);
        std::vector<std::string> words = names;
        for (const std::string& option : allNames(tool)) words.push_back(option);
        text += fmt::format(fmt::runtime(kCommands), fmt::arg("name", name),
                            fmt::arg("words", fmt::join(words, " ")),
                            fmt::arg("commands", fmt::join(names, " | ")));
    }
    text += "  case $command:$prev in\n";
    for (const CommandTable* command : commands) text += valueCases(name, *command);
    text += "  esac\n  case $command in\n";
    for (const CommandTable* command : commands) text += optionCase(name, *command);
    return text + fmt::format("  esac\n}}\ncomplete -F {} {}\n", name, tool.name);
}

}  // namespace pfvox::tools
