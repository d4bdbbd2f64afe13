#include "common/completion_parts.hpp"

#include <algorithm>

namespace pfvox::tools {

std::string singleQuoted(const std::string& text) {
    std::string word = "'";
    for (const char c : text) {
        if (c == '\'') {
            word += "'\\''";
        } else {
            word += c;
        }
    }
    return word + "'";
}

std::string functionName(const CommandTable& tool) {
    std::string name = "_" + tool.name;
    std::ranges::replace(name, '-', '_');
    return name;
}

std::vector<std::string> allNames(const CommandTable& command) {
    std::vector<std::string> names;
    for (const OptionRow& option : command.options)
        names.insert(names.end(), option.names.begin(), option.names.end());
    return names;
}

std::vector<std::string> commandNames(const CommandTable& tool) {
    std::vector<std::string> names;
    for (const CommandTable& command : tool.commands) names.push_back(command.name);
    return names;
}

}  // namespace pfvox::tools
