// Exit codes: what every tool of pfvox tells the build system or script that called it.
//
// The numbers are stable and documented in docs/cli.md and in every --help.
#pragma once

#include <pfvox/error.hpp>
#include <span>
#include <string_view>

namespace pfvox::tools {

enum class ExitCode : int {
    Ok = 0,
    SomeFailed = 1,         ///< the run finished; some assets failed, others did not
    Usage = 2,              ///< the command line makes no sense; nothing was done
    CannotReadOrWrite = 3,  ///< a file or folder is missing, unreadable or unwritable
    InvalidInput = 4,       ///< an input breaks its format or exceeds a limit
    Unsupported = 5,        ///< an input is valid but of a kind or version that this program does not know
    Gpu = 6,                ///< no usable GPU, or it was lost
    Internal = 70,          ///< a fault of ours
    Interrupted = 130,      ///< stopped by Ctrl-C or a termination signal
};

/// The exit code that a failure of this kind gives when it is the only one.
ExitCode exitCodeOf(ErrorCode code);

/// The exit code of a run over several assets: Ok without failures; SomeFailed when another asset succeeded
/// or the failures are of different kinds; otherwise the code that all failures share.
ExitCode exitCodeOf(std::span<const ErrorCode> failures, std::size_t assetCount);

struct ExitCodeText {
    ExitCode code;
    std::string_view text;
};
/// Every code with the words that --help prints, in ascending order.
std::span<const ExitCodeText> exitCodeTexts();

}  // namespace pfvox::tools
