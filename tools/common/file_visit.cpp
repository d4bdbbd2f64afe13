#include "common/file_visit.hpp"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/task_arena.h>

#include "common/inputs.hpp"

namespace pfvox::tools {

void addReadOptions(CLI::App& command, ReadOptions& options, const std::string& extension) {
    command.add_option("input", options.inputs)
        ->required()
        ->check(suggestFiles({extension}))
        ->group(group::kInputOutput);
    addCommonOptions(command, options.common);
}

ExitCode visitFiles(const CLI::App& command, const ReadOptions& options, const std::string& extension,
                    const FileVisitor& visit) {
    Reporter reporter(options.common.reporterSettings());
    const auto limits = parseLimits(options.common.limits);
    if (!limits) return usageError(command, limits.error());
    const auto wanted = [&](const std::filesystem::path& file) { return file.extension() == extension; };
    const auto inputs = collectInputs(options.inputs, {.wanted = wanted, .skippedFolder = {}});
    if (!inputs) {
        reporter.error(inputs.error());
        return exitCodeOf(inputs.error().code);
    }

    const int threads =
        options.common.threads > 0 ? options.common.threads : tbb::this_task_arena::max_concurrency();
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism,
                                      static_cast<std::size_t>(threads));
    tbb::task_arena arena(threads);
    std::vector<ErrorCode> failures;
    for (const InputFile& input : *inputs) {
        const auto failure = arena.execute([&] { return visit(input.file, *limits, reporter); });
        if (failure) failures.push_back(*failure);
    }
    return exitCodeOf(failures, inputs->size());
}

}  // namespace pfvox::tools
