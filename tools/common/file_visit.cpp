#include "common/file_visit.hpp"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/task_arena.h>

#include <new>

#include "common/inputs.hpp"
#include "common/json.hpp"
#include "common/paths.hpp"
#include "common/resources.hpp"

namespace pfvox::tools {

void addReadOptions(CLI::App& command, ReadOptions& options, const std::string& extension) {
    addInputs(command, options.inputs, {extension});
    addCommonOptions(command, options.common);
}

ErrorCode reportFailure(Reporter& reporter, const std::filesystem::path& file, Error error) {
    if (error.file.empty()) error.file = file;
    if (reporter.settings().json)
        reporter.jsonLine(jsonText(Json{{"file", file.string()}, {"error", toJson(error)}}));
    reporter.error(error);
    return error.code;
}

namespace {

std::optional<ErrorCode> visitInput(const InputFile& input, const FileVisitor& visit, const Limits& limits,
                                    Reporter& reporter) {
    if (input.fault) return reportFailure(reporter, input.file, *input.fault);
    try {
        return visit(input.file, limits, reporter);
    } catch (const std::bad_alloc&) {
        return reportFailure(
            reporter, input.file,
            {.code = ErrorCode::LimitExceeded, .message = "not enough memory; fewer threads (-j) may help"});
    }
}

}  // namespace

ExitCode visitFiles(const CLI::App& command, const ReadOptions& options, const std::string& extension,
                    const FileVisitor& visit, const InputsCheck& check) {
    Reporter reporter(options.common.reporterSettings());
    const auto limits = parseLimits(options.common.limits);
    if (!limits) return usageError(command, limits.error());
    const auto wanted = [&](const std::filesystem::path& file) { return hasExtension(file, extension); };
    DiagnosticList leftOut;
    auto inputs = collectInputs(options.inputs, {.wanted = wanted, .skippedFolder = {}}, leftOut);
    reporter.diagnostics({}, leftOut.entries());
    if (!inputs) {
        reporter.error(inputs.error());
        return exitCodeOf(inputs.error().code);
    }
    if (check) {
        if (const std::string complaint = check(*inputs); !complaint.empty())
            return usageError(command, complaint);
    }

    const int wantedThreads =
        options.common.threads > 0 ? options.common.threads : tbb::this_task_arena::max_concurrency();
    const int threads = 1 + affordableThreads(wantedThreads - 1);
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism,
                                      static_cast<std::size_t>(threads));
    tbb::task_arena arena(threads);
    std::vector<ErrorCode> failures;
    for (const InputFile& input : *inputs) {
        const auto failure = arena.execute([&] { return visitInput(input, visit, *limits, reporter); });
        if (failure) failures.push_back(*failure);
    }
    return exitCodeOf(failures, inputs->size());
}

}  // namespace pfvox::tools
