// Program: what main does around the work of every program: signals, exceptions, and whether results have
// arrived.
#pragma once

#include <functional>

#include "common/exit_code.hpp"

namespace pfvox::tools {

/// Runs `work` and returns the exit code of the process. An interrupt ends the process (interrupt.hpp). A
/// reader of the results that went away and a limit on file sizes are errors like a full disk, not the end by
/// a signal. An exception becomes a message: InvalidInput without memory or threads, else Internal. To be
/// called once, before any thread starts.
int runProgram(const std::function<ExitCode()>& work);

}  // namespace pfvox::tools
