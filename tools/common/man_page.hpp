// Man page of a tool, section 1, in the man(7) macros that groff and mandoc read.
#pragma once

#include <string>

#include "common/command_table.hpp"

namespace pfvox::tools {

/// The commands are sections of the one page. Ends in a line end; the same tool gives the same bytes.
std::string manPage(const CommandTable& tool);

}  // namespace pfvox::tools
