#include "common/man_page.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace pfvox::tools {

namespace {

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
    // A line that begins with one of these would be a request.
    return result.starts_with('.') || result.starts_with('\'') ? "\\&" + result : result;
}

std::string upperCase(std::string text) {
    std::ranges::transform(text, text.begin(), [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 32) : c; });
    return text;
}

std::string sentence(const std::string& text) {
    return escaped(text) + (text.ends_with('.') || text.empty() ? "" : ".") + "\n";
}

std::string taggedOption(const OptionRow& option) {
    std::string tag;
    for (const std::string& name : option.names) tag += (tag.empty() ? "\\fB" : ", \\fB") + escaped(name) + "\\fR";
    if (!option.value.empty()) tag += " \\fI" + escaped(option.value) + "\\fR";
    return ".TP\n" + tag + "\n" + sentence(option.meaning);
}

std::string optionList(const std::vector<OptionRow>& options) {
    std::string text;
    const std::string* group = nullptr;
    for (const OptionRow& option : options) {
        if (group == nullptr || *group != option.group) text += ".PP\n" + escaped(option.group) + ":\n";
        group = &option.group;
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
        text += ".TP\n\\fB" + escaped(example.command) + "\\fR\n" + sentence(example.meaning);
    return text;
}

std::string commandSections(const CommandTable& tool, const std::vector<OptionRow>& common) {
    std::string text = ".SH COMMANDS\n";
    for (const CommandTable& command : tool.commands) {
        std::vector<OptionRow> own = command.options;
        std::erase_if(own, [&](const OptionRow& option) { return std::ranges::find(common, option) != common.end(); });
        text += ".SS " + escaped(tool.name + " " + command.name) + "\n" + usageLines(command) + ".PP\n" +
                description(command) + optionList(own);
        if (!command.text.examples.empty())
            text += ".PP\nExamples:\n" + exampleList(command.text.examples);
    }
    return text;
}

std::string exitStatus(const CommandTable& tool) {
    std::string text = ".SH EXIT STATUS\n";
    for (const ExitCodeText& row : tool.exitCodes)
        text += fmt::format(".TP\n\\fB{}\\fR\n{}", static_cast<int>(row.code), sentence(std::string(row.text)));
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
    std::string page = fmt::format(".\\\" Made by `{} --generate man` from the options of the program.\n", tool.name);
    page += fmt::format(".TH {} 1 {} \"pfvox {}\" \"pfvox manual\"\n", upperCase(escaped(tool.name)), PFVOX_MANUAL_DATE,
                        PFVOX_VERSION);
    page += ".SH NAME\n" + escaped(tool.name) + " \\- " + escaped(shortSummary(tool)) + "\n";
    page += ".SH SYNOPSIS\n" + usageLines(tool);
    page += ".SH DESCRIPTION\n" + description(tool);
    if (tool.commands.empty()) {
        page += ".SH OPTIONS\n" + optionList(tool.options);
    } else {
        page += commandSections(tool, common);
        page += ".SH OPTIONS OF ALL COMMANDS\n" + optionList(common);
        page += ".SH OPTIONS WITHOUT A COMMAND\n" + optionList(tool.options);
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
