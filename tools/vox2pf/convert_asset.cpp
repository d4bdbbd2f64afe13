#include "vox2pf/convert_asset.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <new>

#include "common/reporter.hpp"
#include "common/text.hpp"

namespace pfvox::tools {

namespace fs = std::filesystem;

namespace {

/// The existing output, as far as the decision needs it.
struct Existing {
    bool present = false;
    bool damaged = false;
    std::string reason;
    std::uint64_t bytes = 0;
    std::optional<ConvertReport> counts = {};  ///< set exactly when it is up to date
};

/// Nothing for what can only be written to, as a pipe.
std::optional<io::FileBytes> bytesOf(const fs::path& output, const Limits& limits) {
    std::error_code error;
    if (!fs::is_regular_file(output, error)) return std::nullopt;
    auto contents = io::readFile(output, limits.maxFileBytes);
    return contents ? std::optional(*std::move(contents)) : std::nullopt;
}

std::string damageText(const Error& error) {
    return fmt::format("the existing output was damaged ({})", describe(error));
}

/// An output with the right key whose parts are not what their hashes say has changed on the disk.
Existing inspectContent(std::span<const std::byte> bytes, const Limits& limits) {
    DiagnosticList ignored;
    const auto asset = decodePfVox(bytes, limits, ignored);
    if (asset) {
        return {.present = true,
                .reason = "same source, settings and program as in the last conversion",
                .bytes = bytes.size(),
                .counts = countsOf(*asset)};
    }
    if (asset.error().code == ErrorCode::LimitExceeded)
        return {.present = true, .reason = "the existing output cannot be checked within the limits"};
    return {.present = true, .damaged = true, .reason = damageText(asset.error())};
}

Existing inspectOutput(const fs::path& output, const ContentKey& wanted, const Limits& limits) {
    std::error_code error;
    if (!fs::exists(output, error)) return {.reason = "there was no output"};
    const auto contents = bytesOf(output, limits);
    if (!contents) return {.present = true, .reason = "the existing output cannot be read"};
    const auto header = readPfVoxHeader(contents->bytes());
    if (!header) {
        const ErrorCode code = header.error().code;
        const bool damaged = code == ErrorCode::ChecksumMismatch || code == ErrorCode::BadStructure;
        return {.present = true,
                .damaged = damaged,
                .reason = damaged ? damageText(header.error())
                                  : "the existing output is not a PF_VOX file of this version"};
    }
    if (header->fileBytes != contents->bytes().size()) {
        return {.present = true, .reason = "the existing output is not complete"};
    }
    if (header->contentKey != wanted) {
        return {.present = true,
                .reason = "the source, the settings or the program changed since the last conversion"};
    }
    return inspectContent(contents->bytes(), limits);
}

/// Adds the time of its life to a number of seconds.
class AddSeconds {
  public:
    explicit AddSeconds(double& seconds) : seconds_(seconds) {}
    AddSeconds(const AddSeconds&) = delete;
    AddSeconds& operator=(const AddSeconds&) = delete;
    ~AddSeconds() {
        seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    }

  private:
    double& seconds_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Converts, and writes what came out. Sets report, diagnostics, outcome and output.
Result<void> convertAndWrite(const AssetTask& task, std::span<const std::byte> source,
                             const ConvertPolicy& policy, const Limits& limits, AssetResultAndOutput& asset) {
    AssetResult& result = asset.result;
    DiagnosticList diagnostics;
    ConvertReport report;
    auto bytes = convertBytes(source, task.source, task.settings, limits, diagnostics, report);
    const auto found = diagnostics.entries();
    result.diagnostics.insert(result.diagnostics.end(), found.begin(), found.end());
    if (!bytes) return tl::make_unexpected(std::move(bytes).error());

    result.counts = result.conversion = report;
    PFVOX_CHECK(checkWarnings(result, policy));
    result.outputBytes = bytes->size();
    if (policy.ifChanged && holdsBytes(task.output, *bytes, limits)) {
        result.outcome = Outcome::UpToDate;
        result.reason = "converted again; the bytes are the same";
        return {};
    }
    const AddSeconds timer(result.conversion->writeSeconds);
    PFVOX_TRY(io::AtomicFile, file,
              io::AtomicFile::createWith(task.output, *bytes, {.replaceReadOnly = policy.force}));
    asset.output.emplace(std::move(file));
    result.outcome = Outcome::Converted;
    return {};
}

Result<void> decideAndConvert(const AssetTask& task, const ConvertPolicy& policy, const Limits& limits,
                              AssetResultAndOutput& asset) {
    AssetResult& result = asset.result;
    PFVOX_TRY(const io::FileBytes, source, io::readFile(task.source, limits.maxFileBytes));
    result.sourceBytes = source.bytes().size();
    const Existing existing = inspectOutput(task.output, contentKey(source.bytes(), task.settings), limits);
    result.reason = existing.present && policy.force ? "--force" : existing.reason;

    if (existing.counts && !policy.force) {
        result.outcome = Outcome::UpToDate;
        result.outputBytes = existing.bytes;
        result.counts = existing.counts;
        refreshTimeStamp(task.output, policy);
        return {};
    }
    if (existing.present && policy.noClobber) {
        result.outcome = Outcome::Kept;
        return {};
    }
    PFVOX_CHECK(checkOutput(task, policy));
    if (policy.dryRun) {
        result.outcome = Outcome::Planned;
        return {};
    }
    if (existing.damaged) {
        result.isRepair = true;
        result.diagnostics.push_back({.severity = Severity::Note,
                                      .id = "output-damaged",
                                      .message = existing.reason + ": converted again"});
    }
    return convertAndWrite(task, source.bytes(), policy, limits, asset);
}

void failWith(const AssetTask& task, Error error, AssetResult& result) {
    if (error.file.empty()) error.file = task.source;
    result.outcome = Outcome::Failed;
    result.outputBytes.reset();
    result.error = std::move(error);
}

}  // namespace

std::string_view toString(Outcome outcome) {
    switch (outcome) {
        case Outcome::NotStarted:
            return "not-started";
        case Outcome::Converted:
            return "converted";
        case Outcome::UpToDate:
            return "up-to-date";
        case Outcome::Kept:
            return "kept";
        case Outcome::Planned:
            return "planned";
        case Outcome::Failed:
            return "failed";
    }
    return "unknown";
}

Result<void> checkOutput(const AssetTask& task, const ConvertPolicy& policy) {
    auto status = io::checkReplaceable(task.output, {.replaceReadOnly = policy.force});
    std::error_code error;
    if (!status && fs::is_regular_file(task.output, error)) status.error().message += "; --force replaces it";
    return status;
}

bool holdsBytes(const fs::path& output, std::span<const std::byte> bytes, const Limits& limits) {
    const auto contents = bytesOf(output, limits);
    return contents && std::ranges::equal(contents->bytes(), bytes);
}

void refreshTimeStamp(const fs::path& output, const ConvertPolicy& policy) {
    if (!policy.refreshTimeStamp || policy.dryRun) return;
    std::error_code ignored;  // only make would notice, and it would run this again
    fs::last_write_time(output, fs::file_time_type::clock::now(), ignored);
}

Result<void> checkWarnings(const AssetResult& result, const ConvertPolicy& policy) {
    const std::size_t warnings = Reporter::warningCount(result.diagnostics);
    if (!policy.warningsAsErrors || warnings == 0) return {};
    return fail(ErrorCode::BadValue,
                fmt::format("{}, taken as errors: nothing written", plural(warnings, "warning")));
}

void guardResult(const AssetTask& task, AssetResult& result, const std::function<Result<void>()>& work) {
    try {
        auto status = work();
        if (!status) failWith(task, std::move(status).error(), result);
    } catch (const std::bad_alloc&) {
        failWith(
            task,
            {.code = ErrorCode::LimitExceeded, .message = "not enough memory; fewer threads (-j) may help"},
            result);
    } catch (const std::exception& exception) {
        failWith(task, {.code = ErrorCode::Internal, .message = exception.what()}, result);
    }
}

AssetResultAndOutput beginAsset(const AssetTask& task, const ConvertPolicy& policy, const Limits& limits) {
    AssetResultAndOutput asset;
    guardResult(task, asset.result, [&] { return decideAndConvert(task, policy, limits, asset); });
    return asset;
}

void finishAsset(const AssetTask& task, io::AtomicFile output, AssetResult& result) {
    const AddSeconds timer(result.conversion->writeSeconds);
    auto status = output.commit();
    if (!status) failWith(task, std::move(status).error(), result);
}

}  // namespace pfvox::tools
