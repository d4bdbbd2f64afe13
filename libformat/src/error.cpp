#include <fmt/format.h>
#include <cstdio>
#include <cstdlib>
#include <pfvox/assert.hpp>
#include <pfvox/error.hpp>

namespace pfvox {

std::string_view toString(ErrorCode code) {
    switch (code) {
        case ErrorCode::FileNotFound:
            return "file-not-found";
        case ErrorCode::FileNotReadable:
            return "file-not-readable";
        case ErrorCode::FileNotWritable:
            return "file-not-writable";
        case ErrorCode::Truncated:
            return "truncated";
        case ErrorCode::BadMagic:
            return "bad-magic";
        case ErrorCode::BadValue:
            return "bad-value";
        case ErrorCode::BadReference:
            return "bad-reference";
        case ErrorCode::BadStructure:
            return "bad-structure";
        case ErrorCode::ChecksumMismatch:
            return "checksum-mismatch";
        case ErrorCode::NothingToConvert:
            return "nothing-to-convert";
        case ErrorCode::UnsupportedFormat:
            return "unsupported-format";
        case ErrorCode::UnsupportedVersion:
            return "unsupported-version";
        case ErrorCode::UnsupportedFeature:
            return "unsupported-feature";
        case ErrorCode::LimitExceeded:
            return "limit-exceeded";
        case ErrorCode::GpuUnavailable:
            return "gpu-unavailable";
        case ErrorCode::GpuLost:
            return "gpu-lost";
        case ErrorCode::GpuOutOfMemory:
            return "gpu-out-of-memory";
        case ErrorCode::Cancelled:
            return "cancelled";
        case ErrorCode::Internal:
            return "internal";
    }
    return "unknown";
}

std::string describe(const Error& error) {
    std::string text;
    if (!error.file.empty()) text += error.file.string() + ": ";
    if (!error.context.empty()) text += error.context;
    if (error.offsetBytes)
        text += fmt::format("{}@0x{:x}", error.context.empty() ? "" : " ", *error.offsetBytes);
    if (!error.context.empty() || error.offsetBytes) text += ": ";
    return text + error.message;
}

tl::unexpected<Error> fail(ErrorCode code, std::string message) {
    return tl::make_unexpected(Error{.code = code, .message = std::move(message)});
}

tl::unexpected<Error> failAt(ErrorCode code, std::uint64_t offsetBytes, std::string context,
                             std::string message) {
    return tl::make_unexpected(Error{.code = code,
                                     .message = std::move(message),
                                     .offsetBytes = offsetBytes,
                                     .context = std::move(context)});
}

void Diagnostics::note(std::string id, std::string message) {
    report({.severity = Severity::Note, .id = std::move(id), .message = std::move(message)});
}

void Diagnostics::warn(std::string id, std::string message) {
    report({.severity = Severity::Warning, .id = std::move(id), .message = std::move(message)});
}

void DiagnosticList::report(Diagnostic diagnostic) {
    const std::scoped_lock lock(mutex_);
    entries_.push_back(std::move(diagnostic));
}

void detail::assertionFailed(const char* condition, const char* file, int line) {
    // The one place where a library writes to stderr: the process is about to end.
    std::fprintf(stderr, "pfvox: internal error: %s does not hold (%s:%d)\n", condition, file, line);
    std::abort();
}

}  // namespace pfvox
