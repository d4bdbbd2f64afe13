// Unknown options: what to say about one that no command has.
#pragma once

#include <CLI/App.hpp>
#include <optional>
#include <string>

namespace pfvox::tools {

/// After a parse that failed: "unknown option --forse; did you mean --force?", or nothing when every option
/// was known. `command` is the tool itself where it has no commands.
std::optional<std::string> complaintAboutUnknownOption(const CLI::App& tool, const CLI::App& command);

}  // namespace pfvox::tools
