// Completion of a tool's command line in three shells: commands, options, values that are known words, and
// files by their suffixes. Each is one file, to be installed under the name that its shell looks for.
#pragma once

#include <string>

#include "common/command_table.hpp"

namespace pfvox::tools {

std::string bashCompletion(const CommandTable& tool);
std::string zshCompletion(const CommandTable& tool);
std::string fishCompletion(const CommandTable& tool);

}  // namespace pfvox::tools
