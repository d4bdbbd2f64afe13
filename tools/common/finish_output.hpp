// The last act of a tool: making sure that its results have arrived.
#pragma once

#include "common/exit_code.hpp"

namespace pfvox::tools {

/// The exit code that a tool ends with: CannotReadOrWrite, with a message, when results did not reach standard output, as on
/// a full disk; else the one given.
ExitCode finishOutput(ExitCode exitCode);

}  // namespace pfvox::tools
