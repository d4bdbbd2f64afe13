#include "common/man_page.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace pfvox::tools {

namespace {

constexpr std::size_t kLineBytes = 76;

std::string escaped(const std::string& text) {
    std::string result;
    for (const char c : text) {
        if (c == '\\') {
            result += "\\e";
        } else if (c == '-') {
            result += "\\-";
        } else {
            result += c;
        }
    }
    return result;
}

/// Running text in source lines of at most 78 bytes. A line that began with '.' or '\'' would be a request.
std::string filled(const std::string& text) {
    std::string lines;
    std::string line;
    const auto endLine = [&] {
        if (line.starts_with('.') || line.starts_with('\'')) line.insert(0, "\\&");
        if (!line.empty()) lines += line + "\n";
        line.clear();
    };
    for (const std::string& word : CLI::detail::split(escaped(text), ' ')) {
        if (line.size() + word.size() >= kLineBytes) endLine();
        line += (line.empty() ? "" : " ") + word;
    }
    endLine();
    return lines;
}

std::string upperCase(std::string text) {
    std::ranges::transform(text, text.begin(),
                           [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 32) : c; });
    return text;
}

std::string sentence(const std::string& text) {
    return filled(text.ends_with('.') ? text : text + ".");
}

std::string taggedOption(const OptionRow& option) {
    std::string tag;
    for (const std::string& name : option.names)
        tag += (tag.empty() ? "\\fB" : ", \\fB") + escaped(name) + "\\fR";
    if (!option.value.empty()) tag += " \\fI" + escaped(option.value) + "\\fR";
    return ".TP\n" + tag + "\n" + filled(option.meaning);
}

/// Under the names of their groups when there are several. `afterText`: something stands before it in its
/// section.
std::string optionList(const std::vector<OptionRow>& options, bool afterText) {
    std::string text;
    std::string group = options.empty() ? "" : options.front().group;
    const bool isOneGroup = options.empty() || options.back().group == group;
    if (!isOneGroup) group.clear();
    for (const OptionRow& option : options) {
        if (option.group != group)
            text += (afterText || !text.empty() ? ".PP\n" : "") + filled(option.group + ":");
        group = option.group;
        text += taggedOption(option);
    }
    return text;
}

std::string usageLines(const CommandTable& command) {
    std::string text = ".nf\n";
    for (const std::string& line : command.text.usage) {
        if (!line.starts_with(' ')) text += escaped(line) + "\n";
    }
    return text + ".fi\n";
}

std::string description(const CommandTable& command) {
    std::string text = sentence(command.text.summary);
    for (const std::string& line : command.text.usage) {
        if (line.starts_with(' ')) text += ".PP\n" + sentence(line.substr(line.find_first_not_of(' ')));
    }
    for (const std::string& paragraph : command.text.details) text += ".PP\n" + sentence(paragraph);
    return text;
}

std::string exampleList(const std::vector<Example>& examples) {
    std::string text;
    for (const Example& example : examples)
        text += ".TP\n\\fB" + escaped(example.command) + "\\fR\n" + filled(example.meaning);
    return text;
}

std::string commandSections(const CommandTable& tool, const std::vector<OptionRow>& common) {
    std::string text = ".SH COMMANDS\n";
    for (const CommandTable& command : tool.commands) {
        std::vector<OptionRow> own = command.options;
        std::erase_if(
            own, [&](const OptionRow& option) { return std::ranges::find(common, option) != common.end(); });
        text += ".SS " + escaped(tool.name + " " + command.name) + "\n" + usageLines(command) + ".PP\n" +
                description(command) + optionList(own, true);
        if (!command.text.examples.empty()) text += ".PP\nExamples:\n" + exampleList(command.text.examples);
    }
    return text;
}

std::string exitStatus(const CommandTable& tool) {
    std::string text = ".SH EXIT STATUS\n";
    for (const ExitCodeText& row : tool.exitCodes)
        text += fmt::format(".TP\n\\fB{}\\fR\n{}", static_cast<int>(row.code), filled(std::string(row.text)));
    return text;
}

/// The summary after "name - ": without the name and the full stop.
std::string shortSummary(const CommandTable& tool) {
    std::string text = tool.text.summary;
    if (text.starts_with(tool.name + " ")) text.erase(0, tool.name.size() + 1);
    if (text.ends_with('.')) text.pop_back();
    return text;
}

}  // namespace

std::string manPage(const CommandTable& tool) {
    const std::vector<OptionRow> common = commonOptions(tool);
    std::string page =
        fmt::format(".\\\" Made by `{} --generate man` from the options of the program.\n", tool.name);
    page += fmt::format(".TH {} 1 {} \"pfvox {}\" \"pfvox manual\"\n", upperCase(escaped(tool.name)),
                        PFVOX_MANUAL_DATE, PFVOX_VERSION);
    page += ".SH NAME\n" + filled(tool.name + " - " + shortSummary(tool));
    page += ".SH SYNOPSIS\n" + usageLines(tool);
    page += ".SH DESCRIPTION\n" + description(tool);
    if (tool.commands.empty()) {
        page += ".SH OPTIONS\n" + optionList(tool.options, false);
    } else {
        page += commandSections(tool, common);
        page += ".SH OPTIONS OF ALL COMMANDS\n" + optionList(common, false);
        page += ".SH OPTIONS WITHOUT A COMMAND\n" + optionList(tool.options, false);
    }
    if (!tool.text.examples.empty()) page += ".SH EXAMPLES\n" + exampleList(tool.text.examples);
    page += exitStatus(tool) + ".SH SEE ALSO\n";
    std::string others;
    for (const std::string name : {"pfview", "probe-bake", "vox2pf"}) {
        if (name != tool.name) others += (others.empty() ? ".BR " : " ,\n.BR ") + escaped(name) + " (1)";
    }
    return page + others + "\n";
}

}  // namespace pfvox::tools
