#include "common/finish_output.hpp"

#include <cstdio>

namespace pfvox::tools {

ExitCode finishOutput(ExitCode exitCode) {
    if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return exitCode;
    std::fputs("error: the results cannot be written to standard output: is the disk full?\n", stderr);
    return exitCode == ExitCode::Ok ? ExitCode::CannotReadOrWrite : exitCode;
}

}  // namespace pfvox::tools
