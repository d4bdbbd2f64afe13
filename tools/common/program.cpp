#include "common/program.hpp"

#include <poll.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <exception>
#include <new>
#include <system_error>

#include "common/interrupt.hpp"

namespace pfvox::tools {

namespace {

/// What failed first is forgotten by now; a pipe without a reader can be asked.
bool hasLostReader() {
    pollfd out{.fd = STDOUT_FILENO, .events = POLLOUT, .revents = 0};
    return ::poll(&out, 1, 0) == 1 && (out.revents & POLLERR) != 0;
}

/// CannotReadOrWrite, with a message, when results did not reach standard output, as on a full disk.
ExitCode finishOutput(ExitCode exitCode) {
    if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return exitCode;
    if (hasLostReader()) {
        std::fputs("error: the results cannot be written to standard output: its reader has gone\n", stderr);
    } else {
        std::fputs("error: the results cannot be written to standard output: is the disk full?\n", stderr);
    }
    return exitCode == ExitCode::Ok ? ExitCode::CannotReadOrWrite : exitCode;
}

ExitCode guarded(const std::function<ExitCode()>& work) {
    try {
        exitOnInterrupt();
        return work();
    } catch (const std::bad_alloc&) {
        std::fputs(
            "error: not enough memory: use fewer threads (-j) or a smaller input, or raise the limit (ulimit "
            "-v)\n",
            stderr);
        return ExitCode::InvalidInput;
    } catch (const std::system_error& error) {
        if (error.code() == std::errc::resource_unavailable_try_again) {
            std::fputs(
                "error: no thread can be started: raise the limit of processes (ulimit -u) or of memory "
                "(ulimit -v)\n",
                stderr);
            return ExitCode::InvalidInput;
        }
        std::fprintf(stderr, "error: internal error: %s; please report it with the command line\n",
                     error.what());
    } catch (const std::exception& exception) {
        std::fprintf(stderr, "error: internal error: %s; please report it with the command line\n",
                     exception.what());
    }
    return ExitCode::Internal;
}

}  // namespace

int runProgram(const std::function<ExitCode()>& work) {
    // Writing then fails with a reason.
    for (const int signal : {SIGPIPE, SIGXFSZ}) std::signal(signal, SIG_IGN);
    return static_cast<int>(finishOutput(guarded(work)));
}

}  // namespace pfvox::tools
