#include "common/exit_code.hpp"

#include <algorithm>
#include <array>

namespace pfvox::tools {

ExitCode exitCodeOf(ErrorCode code) {
    switch (static_cast<unsigned>(code) / 100) {
        case 1:
            return ExitCode::CannotReadOrWrite;
        case 2:
        case 4:
            return ExitCode::InvalidInput;
        case 3:
            return ExitCode::Unsupported;
        case 5:
            return ExitCode::Gpu;
        case 6:
            return ExitCode::Interrupted;
        default:
            return ExitCode::Internal;
    }
}

ExitCode exitCodeOf(std::span<const ErrorCode> failures, std::size_t assetCount) {
    if (failures.empty()) return ExitCode::Ok;
    const ExitCode first = exitCodeOf(failures.front());
    const bool alike =
        std::ranges::all_of(failures, [&](ErrorCode code) { return exitCodeOf(code) == first; });
    return alike && failures.size() == assetCount ? first : ExitCode::SomeFailed;
}

std::span<const ExitCodeText> exitCodeTexts() {
    static constexpr std::array<ExitCodeText, 9> kTexts{{
        {ExitCode::Ok, "success"},
        {ExitCode::SomeFailed, "finished, but some assets failed"},
        {ExitCode::Usage, "wrong usage"},
        {ExitCode::CannotReadOrWrite, "cannot read or write a file"},
        {ExitCode::InvalidInput, "input invalid or beyond a limit"},
        {ExitCode::Unsupported, "unsupported format, feature or version"},
        {ExitCode::Gpu, "GPU unavailable or lost"},
        {ExitCode::Internal, "internal error"},
        {ExitCode::Interrupted, "interrupted"},
    }};
    return kTexts;
}

}  // namespace pfvox::tools
