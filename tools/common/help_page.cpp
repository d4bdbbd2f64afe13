#include "common/help_page.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "common/command_line.hpp"
#include "common/command_table.hpp"
#include "common/completion.hpp"
#include "common/man_page.hpp"
#include "common/text.hpp"

namespace pfvox::tools {

namespace {

using TextRows = std::vector<std::pair<std::string, std::string>>;

/// "  left    right" with the right parts in one column.
std::string twoColumns(const TextRows& rows) {
    std::size_t width = 0;
    for (const auto& row : rows) width = std::max(width, displayWidth(row.first));
    std::string text;
    for (const auto& [left, right] : rows) {
        text += fmt::format("  {}{}  {}\n", left, std::string(width - displayWidth(left), ' '), right);
    }
    return text;
}

std::string commandsText(const CommandTable& tool) {
    TextRows rows;
    for (const CommandTable& command : tool.commands) rows.emplace_back(command.name, command.text.summary);
    if (rows.empty()) return {};
    return fmt::format("\nCommands (`{} <command> --help` tells more):\n", tool.name) + twoColumns(rows);
}

std::string optionsText(const CommandTable& command) {
    std::string text;
    for (auto option = command.options.begin(); option != command.options.end();) {
        const std::string& group = option->group;
        TextRows rows;
        for (; option != command.options.end() && option->group == group; ++option)
            rows.emplace_back(signatureOf(*option), option->meaning);
        text += "\n" + group + ":\n" + twoColumns(rows);
    }
    return text;
}

std::string helpPage(const CommandTable& command) {
    std::string page = command.text.summary + "\n\nUsage:\n";
    for (const std::string& line : command.text.usage) page += "  " + line + "\n";
    page += commandsText(command) + optionsText(command);
    TextRows examples;
    for (const Example& example : command.text.examples)
        examples.emplace_back(example.command, example.meaning);
    if (!examples.empty()) page += "\nExamples:\n" + twoColumns(examples);
    TextRows codes;
    for (const ExitCodeText& entry : command.exitCodes)
        codes.emplace_back(fmt::format("{:3}", static_cast<int>(entry.code)), std::string(entry.text));
    return page + "\nExit codes:\n" + twoColumns(codes);
}

/// Writes the help page, and keeps the words for who else needs them.
class HelpFormatter final : public CLI::Formatter {
  public:
    explicit HelpFormatter(HelpText text) : text_(std::move(text)) {}
    std::string make_help(const CLI::App* app, std::string, CLI::AppFormatMode) const override {
        return helpPage(commandTable(*app));
    }
    const HelpText& text() const { return text_; }

  private:
    HelpText text_;
};

void describe(CLI::App& app, const HelpText& text) {
    app.formatter(std::make_shared<HelpFormatter>(text));
    app.set_help_flag("-h,--help", "print this page")->group(group::kGeneral);
}

/// Without the line end, which whoever prints it adds, as to a version.
std::string generate(const CommandTable& tool, const std::string& what) {
    std::string text = what == "man"    ? manPage(tool)
                       : what == "bash" ? bashCompletion(tool)
                       : what == "zsh"  ? zshCompletion(tool)
                                        : fishCompletion(tool);
    text.pop_back();
    return text;
}

}  // namespace

std::unique_ptr<CLI::App> makeTool(const std::string& name, const HelpText& text,
                                   const std::string& version) {
    auto tool = std::make_unique<CLI::App>(text.summary, name);
    describe(*tool, text);
    tool->set_version_flag("--version", version, "print the version and the formats read and written")
        ->group(group::kGeneral);
    const auto print = [app = tool.get()](const std::string& what) {
        throw CLI::CallForVersion(generate(commandTable(*app), what), 0);
    };
    tool->add_option_function<std::string>("--generate", print)
        ->check(CLI::IsMember({"man", "bash", "zsh", "fish"}))
        ->group("");  // hidden: for the build
    return tool;
}

CLI::App& addCommand(CLI::App& tool, const std::string& name, const HelpText& text) {
    CLI::App& command = *tool.add_subcommand(name, text.summary);
    describe(command, text);
    return command;
}

const HelpText& helpTextOf(const CLI::App& app) {
    static const HelpText kNone;
    const auto formatter = std::dynamic_pointer_cast<const HelpFormatter>(app.get_formatter());
    return formatter ? formatter->text() : kNone;
}

CLI::Validator suggestFiles(const std::vector<std::string>& suffixes) {
    return CLI::Validator([](std::string&) { return std::string(); },
                          fmt::format("files({})", fmt::join(suffixes, " ")));
}

CLI::Validator suggestWords(const std::vector<std::string>& words) {
    return CLI::Validator([](std::string&) { return std::string(); },
                          fmt::format("{{{}}}", fmt::join(words, ",")));
}

CLI::Validator showDefault(const std::string& text) {
    return CLI::Validator([](std::string&) { return std::string(); }, fmt::format("default<{}>", text));
}

}  // namespace pfvox::tools
