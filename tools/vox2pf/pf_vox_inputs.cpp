#include "vox2pf/pf_vox_inputs.hpp"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/task_arena.h>
#include <pfvox/import.hpp>

#include "common/inputs.hpp"
#include "vox2pf/commands.hpp"

namespace pfvox::tools {

void addReadOptions(CLI::App& command, ReadOptions& options) {
    command.add_option("input", options.inputs)->required()->group(group::kInputOutput);
    addCommonOptions(command, options.common);
}

ExitCode visitPfVoxFiles(const CLI::App& command, const ReadOptions& options, const FileVisitor& visit) {
    Reporter reporter(options.common.reporterSettings());
    const auto limits = parseLimits(options.common.limits);
    if (!limits) return usageError(command, limits.error());
    const auto isPfVox = [](const std::filesystem::path& file) {
        return file.extension() == kPfVoxExtension;
    };
    const auto inputs = collectInputs(options.inputs, {.wanted = isPfVox, .skippedFolder = {}});
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

Error withRemedy(Error error) {
    if (error.code == ErrorCode::BadMagic && looksLikeSource(error.file) &&
        error.file.extension() != kPfVoxExtension) {
        const std::filesystem::path output =
            std::filesystem::path(error.file).replace_extension(kPfVoxExtension);
        error.message += ". This is a source file; convert it first: vox2pf " + error.file.string() + " -o " +
                         output.string();
    }
    return error;
}

}  // namespace pfvox::tools
