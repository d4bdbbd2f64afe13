#include "vox2pf/convert_asset.hpp"

#include <fmt/format.h>
#include <pfvox/files.hpp>

#include <algorithm>
#include <new>

#include "common/interrupt.hpp"
#include "common/reporter.hpp"
#include "common/text.hpp"

namespace pfvox::tools {

namespace fs = std::filesystem;

namespace {

/// The existing output, as far as the decision needs it.
struct Existing {
    bool present = false;
    bool upToDate = false;
    std::string reason;
};

Existing inspectOutput(const fs::path& output, const ContentKey& wanted, const Limits& limits) {
    std::error_code error;
    if (!fs::exists(output, error)) return {.reason = "there was no output"};
    const auto contents = io::readFile(output, limits.maxFileBytes);
    if (!contents) return {.present = true, .reason = "the existing output cannot be read"};
    const auto header = readPfVoxHeader(contents->bytes());
    if (!header)
        return {.present = true, .reason = "the existing output is not a PF_VOX file of this version"};
    if (header->fileBytes != contents->bytes().size()) {
        return {.present = true, .reason = "the existing output is not complete"};
    }
    if (header->contentKey != wanted) {
        return {.present = true,
                .reason = "the source, the settings or the program changed since the last conversion"};
    }
    return {.present = true,
            .upToDate = true,
            .reason = "same source, settings and program as in the last conversion"};
}

/// Converts, and writes what came out. Sets report, diagnostics and outcome.
Result<void> convertAndWrite(const AssetTask& task, std::span<const std::byte> source,
                             const ConvertPolicy& policy, const Limits& limits, AssetResult& result) {
    DiagnosticList diagnostics;
    auto bytes = convertBytes(source, task.source, task.settings, limits, diagnostics, result.report);
    result.diagnostics = diagnostics.entries();
    if (!bytes) return tl::make_unexpected(std::move(bytes).error());

    PFVOX_CHECK(checkWarnings(result, policy));
    if (policy.ifChanged && holdsBytes(task.output, *bytes, limits)) {
        result.outcome = Outcome::UpToDate;
        result.reason = "converted again; the bytes are the same";
        return {};
    }
    const WriteGuard guard;
    PFVOX_CHECK(io::writeFileAtomically(task.output, *bytes));
    result.outcome = Outcome::Converted;
    return {};
}

Result<void> decideAndConvert(const AssetTask& task, const ConvertPolicy& policy, const Limits& limits,
                              AssetResult& result) {
    PFVOX_TRY(const io::FileBytes, source, io::readFile(task.source, limits.maxFileBytes));
    result.report.sourceBytes = source.bytes().size();
    const Existing existing = inspectOutput(task.output, contentKey(source.bytes(), task.settings), limits);
    result.reason = existing.present && policy.force ? "--force" : existing.reason;

    if (existing.upToDate && !policy.force) {
        result.outcome = Outcome::UpToDate;
        refreshTimeStamp(task.output, policy);
        return {};
    }
    if (existing.present && policy.noClobber) {
        result.outcome = Outcome::Kept;
        return {};
    }
    if (policy.dryRun) {
        result.outcome = Outcome::Planned;
        return {};
    }
    return convertAndWrite(task, source.bytes(), policy, limits, result);
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

bool holdsBytes(const fs::path& output, std::span<const std::byte> bytes, const Limits& limits) {
    const auto contents = io::readFile(output, limits.maxFileBytes);
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

AssetResult guardedResult(const AssetTask& task, const std::function<Result<void>(AssetResult&)>& work) {
    AssetResult result;
    const auto failWith = [&](Error error) {
        if (error.file.empty()) error.file = task.source;
        result.outcome = Outcome::Failed;
        result.error = std::move(error);
    };
    try {
        auto status = work(result);
        if (!status) failWith(std::move(status).error());
    } catch (const std::bad_alloc&) {
        failWith(
            {.code = ErrorCode::LimitExceeded, .message = "not enough memory; fewer threads (-j) may help"});
    } catch (const std::exception& exception) {
        failWith({.code = ErrorCode::Internal, .message = exception.what()});
    }
    return result;
}

AssetResult convertAsset(const AssetTask& task, const ConvertPolicy& policy, const Limits& limits) {
    return guardedResult(task,
                         [&](AssetResult& result) { return decideAndConvert(task, policy, limits, result); });
}

}  // namespace pfvox::tools
