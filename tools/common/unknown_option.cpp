#include "common/unknown_option.hpp"

#include <fmt/format.h>

#include <vector>

#include "common/text.hpp"

namespace pfvox::tools {

namespace {

/// Of all groups: an option group is an app of its own within the command.
void addOptionNames(const CLI::App& command, std::vector<std::string>& names) {
    for (const CLI::Option* option : command.get_options()) {
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    }
    const auto isGroup = [](const CLI::App* app) { return app->get_name().empty(); };
    for (const CLI::App* group : command.get_subcommands(isGroup)) addOptionNames(*group, names);
}

}  // namespace

std::optional<std::string> complaintAboutUnknownOption(const CLI::App& tool, const CLI::App& command) {
    for (const std::string& word : tool.remaining(true)) {
        if (!word.starts_with('-') || word == "--") continue;
        const std::string name = word.substr(0, word.find('='));
        std::vector<std::string> names;
        addOptionNames(command, names);
        const auto nearest = nearestWord(name, names);
        return fmt::format("unknown option {}{}", name, nearest ? "; did you mean " + *nearest + "?" : "");
    }
    return std::nullopt;
}

}  // namespace pfvox::tools
