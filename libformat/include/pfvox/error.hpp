// Errors, results and diagnostics: how every stage of pfvox reports what went wrong.
//
// Three kinds of trouble, three ways (docs/architecture.md, "Errors"):
//   1. wrong input or environment  -> Result<T> with an Error (this header);
//   2. suspicious but usable input -> a Diagnostic sent to a Diagnostics sink; the tool prints or promotes
//   it;
//   3. a fault of ours             -> PFVOX_ASSERT (pfvox/assert.hpp).
// No exception crosses a public header of pfvox.
#pragma once

#include <cstdint>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

namespace pfvox {

/// What kind of thing went wrong. The numbers are stable and listed in docs/cli.md; the hundreds select the
/// exit code of the tools (1xx -> 3, 2xx -> 4, 3xx -> 5, 4xx -> 4, 5xx -> 6, 6xx -> 130, 9xx -> 70).
enum class ErrorCode : std::uint16_t {
    // Reading and writing
    FileNotFound = 100,
    FileNotReadable = 101,
    FileNotWritable = 102,
    // Input invalid
    Truncated = 200,         ///< the data ends before a structure that it announces
    BadMagic = 201,          ///< not a file of the announced kind
    BadValue = 202,          ///< a field holds a value outside its domain
    BadReference = 203,      ///< an index or id names something that does not exist
    BadStructure = 204,      ///< parts contradict each other (cycles, overlaps, wrong sums)
    ChecksumMismatch = 205,  ///< stored and computed hash differ
    NothingToConvert = 206,  ///< valid, but holds no voxel model
    // Valid, but not for this program
    UnsupportedFormat = 300,
    UnsupportedVersion = 301,
    UnsupportedFeature = 302,
    // Larger than Limits allow
    LimitExceeded = 400,
    // GPU
    GpuUnavailable = 500,
    GpuLost = 501,
    GpuOutOfMemory = 502,
    // The user asked to stop
    Cancelled = 600,
    // Ours
    Internal = 900,
};

/// The stable spelling of a code, for example "truncated" or "bad-reference".
std::string_view toString(ErrorCode code);

/// One failure with its place. `message` says what is wrong and, where there is one, the remedy.
struct Error {
    ErrorCode code = ErrorCode::Internal;                     ///< what kind; stable
    std::string message;                                      ///< what is wrong and what to do
    std::filesystem::path file = {};                          ///< the file at fault; empty while not known
    std::optional<std::uint64_t> offsetBytes = std::nullopt;  ///< where in that file
    std::string context = {};                                 ///< the structure at that place, "chunk nTRN"
};

/// "hall.vox: chunk nTRN @0x1a3f: child node 77 does not exist".
std::string describe(const Error& error);

/// A value or an Error. A class of its own, because a plain alias of tl::expected is not [[nodiscard]] in
/// GCC 12.
template <class T>
class [[nodiscard]] Result : public tl::expected<T, Error> {
  public:
    using tl::expected<T, Error>::expected;
};

/// Makes the failing side of a Result.
[[nodiscard]] tl::unexpected<Error> fail(ErrorCode code, std::string message);
[[nodiscard]] tl::unexpected<Error> failAt(ErrorCode code, std::uint64_t offsetBytes, std::string context,
                                           std::string message);  ///< An error with its place in the file.
/// How much a diagnostic matters.
enum class Severity : std::uint8_t { Note, Warning };

/// Something the user should know about input that is used all the same. `id` is stable
/// ("vox-duplicate-voxels"), so that tools can count and tests can match; `message` is for people.
struct Diagnostic {
    Severity severity = Severity::Warning;                    ///< note or warning
    std::string id;                                           ///< stable: "vox-voxels-outside"
    std::string message;                                      ///< what was seen and what was done about it
    std::optional<std::uint64_t> offsetBytes = std::nullopt;  ///< in the file, where known
};

/// Where stages send diagnostics. Implementations are thread-safe: stages report from parallel tasks.
class Diagnostics {
  public:
    Diagnostics() = default;
    Diagnostics(const Diagnostics&) = delete;
    Diagnostics& operator=(const Diagnostics&) = delete;
    virtual ~Diagnostics() = default;

    virtual void report(Diagnostic diagnostic) = 0;  ///< Called as it is met; must not throw.

    void note(std::string id, std::string message);  ///< report() with Severity::Note
    void warn(std::string id, std::string message);  ///< report() with Severity::Warning
};

/// Collects diagnostics in the order of their arrival.
class DiagnosticList final : public Diagnostics {
  public:
    void report(Diagnostic diagnostic) override;  ///< Adds it at the end.
    /// Everything reported so far. Not to be called while another thread reports.
    const std::vector<Diagnostic>& entries() const { return entries_; }

  private:
    std::mutex mutex_;
    std::vector<Diagnostic> entries_;
};

}  // namespace pfvox

/// Hands the error of a Result on to the caller: PFVOX_TRY(auto, header, readHeader(cursor)) declares
/// `auto header` with the value.
#define PFVOX_TRY(type, name, ...) PFVOX_TRY_IMPL(type, name, __LINE__, __VA_ARGS__)
#define PFVOX_TRY_IMPL(type, name, line, ...) PFVOX_TRY_IMPL2(type, name, line, __VA_ARGS__)
#define PFVOX_TRY_IMPL2(type, name, line, ...)                                                \
    auto pfvoxResult##line = (__VA_ARGS__);                                                   \
    if (!pfvoxResult##line) return tl::make_unexpected(std::move(pfvoxResult##line).error()); \
    type name = *std::move(pfvoxResult##line)

/// The same for a Result<void>.
#define PFVOX_CHECK(...)                                                              \
    do {                                                                              \
        auto pfvoxStatus = (__VA_ARGS__);                                             \
        if (!pfvoxStatus) return tl::make_unexpected(std::move(pfvoxStatus).error()); \
    } while (false)
