// Completion parts: what the completions of all shells need.
#pragma once

#include <string>
#include <vector>

#include "common/command_table.hpp"

namespace pfvox::tools {

/// The text as one word of any of the shells: 'it'\''s'.
std::string singleQuoted(const std::string& text);
/// "_probe_bake" of probe-bake.
std::string functionName(const CommandTable& tool);
/// Every spelling of every option.
std::vector<std::string> allNames(const CommandTable& command);
std::vector<std::string> commandNames(const CommandTable& tool);

}  // namespace pfvox::tools
