#include "common/command_table.hpp"

#include <algorithm>

#include "common/command_line.hpp"

namespace pfvox::tools {

namespace {

/// The part of `text` between `open` and `close`; nothing when it is not there.
std::string textIn(const std::string& text, const std::string& open, char close) {
    const std::size_t begin = text.find(open);
    if (begin == std::string::npos) return {};
    const std::size_t start = begin + open.size();
    return text.substr(start, text.find(close, start) - start);
}

/// The same, cut at `separator`.
std::vector<std::string> listIn(const std::string& text, const std::string& open, char close,
                                char separator) {
    std::vector<std::string> words;
    for (std::string& word : CLI::detail::split(textIn(text, open, close), separator)) {
        word.resize(std::min(word.size(), word.find("->")));  // a transformer lists what becomes what
        if (!word.empty()) words.push_back(std::move(word));
    }
    return words;
}

/// CLI11 keeps no data of ours with an option; its checks' descriptions, which follow the type's name, carry
/// them.
OptionRow rowOf(const CLI::Option& option, const std::string& group) {
    const std::string checks = option.get_type_name();
    OptionRow row{.names = {},
                  .value = {},
                  .meaning = option.get_description(),
                  .defaultText = textIn(checks, "default<", '>'),
                  .group = group,
                  .words = listIn(checks, "{", '}', ','),
                  .isFile = checks.find("files(") != std::string::npos,
                  .suffixes = listIn(checks, "files(", ')', ' ')};
    if (!row.defaultText.empty()) row.meaning += " (default: " + row.defaultText + ")";
    for (const std::string& name : option.get_snames()) row.names.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) row.names.push_back("--" + name);
    if (row.names.empty()) {
        row.value = option.get_name();
    } else if (option.get_items_expected_max() > 0) {
        row.value =
            option.get_option_text().empty() ? checks.substr(0, checks.find(':')) : option.get_option_text();
    }
    return row;
}

struct Rows {
    std::vector<OptionRow> options;
    std::vector<OptionRow> arguments;
};

void collect(const CLI::App& app, const std::string& groupName, Rows& rows) {
    for (const CLI::Option* option : app.get_options()) {
        if (option->get_group().empty()) continue;  // hidden
        if (!groupName.empty() && option == app.get_help_ptr()) continue;
        OptionRow row = rowOf(*option, groupName.empty() ? option->get_group() : groupName);
        (row.names.empty() ? rows.arguments : rows.options).push_back(std::move(row));
    }
    // CLI11's option groups are subcommands without a name.
    for (const CLI::App* group :
         app.get_subcommands([](const CLI::App* sub) { return sub->get_name().empty(); })) {
        collect(*group, group->get_group(), rows);
    }
}

/// Groups in the order of their first option, the general one last; the order within a group stays.
void sortByGroup(std::vector<OptionRow>& options) {
    std::vector<std::string> groups;
    for (const OptionRow& option : options) {
        if (std::ranges::find(groups, option.group) == groups.end()) groups.push_back(option.group);
    }
    std::stable_partition(groups.begin(), groups.end(),
                          [](const std::string& name) { return name != group::kGeneral; });
    std::ranges::stable_sort(options, {}, [&](const OptionRow& option) {
        return std::ranges::find(groups, option.group) - groups.begin();
    });
}

std::vector<ExitCodeText> exitCodesOf(const HelpText& text) {
    std::vector<ExitCodeText> rows;
    for (const ExitCodeText& row : exitCodeTexts()) {
        if (text.exitCodes.empty() || std::ranges::find(text.exitCodes, row.code) != text.exitCodes.end())
            rows.push_back(row);
    }
    return rows;
}

}  // namespace

CommandTable commandTable(const CLI::App& app) {
    Rows rows;
    collect(app, {}, rows);
    sortByGroup(rows.options);
    const HelpText& text = helpTextOf(app);
    CommandTable table{.name = app.get_name(),
                       .text = text,
                       .options = std::move(rows.options),
                       .arguments = std::move(rows.arguments),
                       .exitCodes = exitCodesOf(text),
                       .commands = {}};
    for (const CLI::App* command :
         app.get_subcommands([](const CLI::App* sub) { return !sub->get_name().empty(); }))
        table.commands.push_back(commandTable(*command));
    return table;
}

std::string signatureOf(const OptionRow& option) {
    std::string text;
    for (const std::string& name : option.names) text += (text.empty() ? "" : ", ") + name;
    if (text.starts_with("--")) text = "    " + text;
    return option.value.empty() ? text : text + " " + option.value;
}

std::vector<OptionRow> commonOptions(const CommandTable& tool) {
    if (tool.commands.empty()) return {};
    std::vector<OptionRow> common = tool.commands.front().options;
    for (const CommandTable& command : tool.commands) {
        std::erase_if(common, [&](const OptionRow& option) {
            return std::ranges::find(command.options, option) == command.options.end();
        });
    }
    return common;
}

std::vector<const CommandTable*> chooseable(const CommandTable& tool) {
    if (tool.commands.empty()) return {&tool};
    std::vector<const CommandTable*> commands;
    for (const CommandTable& command : tool.commands) commands.push_back(&command);
    return commands;
}

const CommandTable& defaultOf(const CommandTable& tool) {
    for (const CommandTable& command : tool.commands) {
        if (command.name == tool.text.defaultCommand) return command;
    }
    return tool;
}

}  // namespace pfvox::tools
