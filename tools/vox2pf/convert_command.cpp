#include <map>
#include <memory>
#include <pfvox/import.hpp>

#include "common/batch.hpp"
#include "common/depfile.hpp"
#include "common/inputs.hpp"
#include "common/output_paths.hpp"
#include "common/progress.hpp"
#include "vox2pf/commands.hpp"
#include "vox2pf/convert_report.hpp"
#include "vox2pf/settings.hpp"

namespace pfvox::tools {

namespace {

struct ConvertOptions {
    CommonOptions common;
    std::vector<std::string> inputs;
    std::string output;
    std::string settingsFile;
    std::string depfile;
    SettingsPatch patch;
    bool archive = false;
    bool force = false;
    bool noClobber = false;
    bool dryRun = false;
    bool explain = false;
    bool failFast = false;
    bool ifChanged = false;
    bool warningsAsErrors = false;
};

HelpText helpText() {
    return {
        .summary = "Converts voxel sources to PF_VOX files. What is up to date by its content is left alone.",
        .usage = {"vox2pf [convert] [options] <file | folder | @list | ->... -o <file | folder>",
                  "  @list is a text file with one input a line, - is such a list on stdin"},
        .examples = {{"vox2pf hall.vox -o hall.pf_vox", "one file"},
                     {"vox2pf assets -o build/assets -j 4", "a folder with its subfolders, on 4 threads"},
                     {"vox2pf assets -o build/assets --dry-run --explain", "what would be done, and why"}}};
}

void addInputOutputOptions(CLI::App& command, ConvertOptions& options) {
    command.add_option("input", options.inputs)->required()->group(group::kInputOutput);
    command.add_option("-o,--output", options.output, "file (.pf_vox) for one input, else folder; required")
        ->option_text("PATH")
        ->required()
        ->group(group::kInputOutput);
    auto* force = command.add_flag("--force", options.force, "convert what is up to date, too")
                      ->group(group::kInputOutput);
    command.add_flag("--no-clobber", options.noClobber, "never replace an existing output")
        ->excludes(force)
        ->group(group::kInputOutput);
    command.add_flag("--dry-run", options.dryRun, "write nothing, say what would be written")
        ->group(group::kInputOutput);
    command.add_flag("--explain", options.explain, "say of every file why it is converted or not")
        ->group(group::kInputOutput);
}

/// What decides how an asset is built and written.
void addOctreeOptions(CLI::App& command, ConvertOptions& options) {
    SettingsPatch& patch = options.patch;
    command
        .add_flag_function(
            "--hollow,!--no-hollow", [&patch](std::int64_t count) { patch.hollow = count > 0; },
            "let voxels that cannot be seen take another material (lossy inside)")
        ->group(group::kConversion);
    command
        .add_flag_function(
            "--lod,!--no-lod", [&patch](std::int64_t count) { patch.lod = count > 0; },
            "add colours for level of detail, at about twice the size")
        ->group(group::kConversion);
    command.add_flag("--archive", options.archive, "compress harder (zstd 9 instead of 3)")
        ->group(group::kConversion);
    command
        .add_option_function<std::string>(
            "--profile", [&patch](const std::string& name) { patch.profile = parseProfile(name); },
            "packed (default): small; resident: as the GPU reads it")
        ->option_text("NAME")
        ->check(CLI::IsMember({"packed", "resident"}))
        ->group(group::kConversion);
}

void addConversionOptions(CLI::App& command, ConvertOptions& options) {
    SettingsPatch& patch = options.patch;
    const auto setTrue = [](std::optional<bool>& flag) { return [&flag](std::int64_t) { flag = true; }; };
    command
        .add_option("--settings", options.settingsFile,
                    "TOML file with [import], [build], [encode], [[override]]")
        ->option_text("FILE")
        ->group(group::kConversion);
    command.add_flag_function("--merge", setTrue(patch.merge), "flatten all instances into one model")
        ->group(group::kConversion);
    command
        .add_flag_function("--include-hidden", setTrue(patch.includeHidden),
                           "keep hidden layers and nodes, visible")
        ->group(group::kConversion);
    command.add_option("--frame", patch.frame, "animation frame, 0 or more (default 0)")
        ->option_text("N")
        ->check(numberFrom(0, kMaxFrame))
        ->group(group::kConversion);
    command
        .add_option("--voxel-size", patch.voxelSizeMetres,
                    "edge of a voxel, 1e-6 to 1e6 (default: as in the source, else 0.1)")
        ->option_text("METRES")
        ->check(numberFrom(kMinVoxelSizeMetres, kMaxVoxelSizeMetres))
        ->group(group::kConversion);
    command
        .add_option("--svx-threshold", patch.svxThreshold,
                    "SVX: density of a solid voxel, 0 to 1 of the largest (default 0.5)")
        ->option_text("SHARE")
        ->check(numberFrom(0.0, 1.0))
        ->group(group::kConversion);
    command
        .add_option("--vdb-grid", patch.vdbGrids, "OpenVDB: import this grid; may be given again (default: all)")
        ->option_text("NAME")
        ->group(group::kConversion);
    command
        .add_option("--vdb-threshold", patch.vdbThreshold,
                    "OpenVDB fog: a voxel is solid above this value (default 0)")
        ->option_text("VALUE")
        ->check(numberFrom(-kMaxVdbThreshold, kMaxVdbThreshold))
        ->group(group::kConversion);
    command.add_option("--vdb-up", patch.vdbUpAxis, "OpenVDB: which axis points up, y or z (default y)")
        ->option_text("AXIS")
        ->transform(CLI::Transformer(std::map<std::string, UpAxis>{{"y", UpAxis::Y}, {"z", UpAxis::Z}}))
        ->group(group::kConversion);
    addOctreeOptions(command, options);
}

void addBuildOptions(CLI::App& command, ConvertOptions& options) {
    command
        .add_option("--depfile", options.depfile, "write what each output was made from, for make and ninja")
        ->option_text("FILE")
        ->group(group::kBuild);
    command
        .add_flag("--if-changed", options.ifChanged,
                  "keep the time stamp of outputs that stay the same (ninja)")
        ->group(group::kBuild);
    command.add_flag("--fail-fast", options.failFast, "start no further file after a failure")
        ->group(group::kBuild);
    command
        .add_flag("--warnings-as-errors", options.warningsAsErrors,
                  "a file with warnings fails, nothing is written")
        ->group(group::kBuild);
}

/// One run of the command, from checked options to the exit code.
class ConvertRun {
  public:
    ConvertRun(const ConvertOptions& options, const Limits& limits, Reporter& reporter)
        : options_(options), limits_(limits), reporter_(reporter) {}

    ExitCode run(std::vector<AssetTask> tasks) {
        tasks_ = std::move(tasks);
        results_.resize(tasks_.size());
        outputs_.resize(tasks_.size());
        Progress progress(reporter_, tasks_.size());
        runBatch(tasks_.size(), {.threads = options_.common.threads, .failFast = options_.failFast},
                 {.work = [&](std::size_t i) { return work(i); },
                  .commit = [&](std::size_t i) { return commit(i); },
                  .finished = [&](std::size_t i) { report(i); },
                  .progressed = [&](std::size_t i) { progress.advance(results_[i].report.voxels); }});
        reporter_.clearProgress();
        reportUnstarted();
        const bool depfileGood = writeDependencies();
        reporter_.result(summary(tasks_, results_, progress.elapsedSeconds()));
        return depfileGood ? exitCode() : ExitCode::CannotReadOrWrite;
    }

  private:
    bool work(std::size_t i) {
        const ConvertPolicy policy{.force = options_.force,
                                   .noClobber = options_.noClobber,
                                   .dryRun = options_.dryRun,
                                   .ifChanged = options_.ifChanged,
                                   .refreshTimeStamp = !options_.depfile.empty() && !options_.ifChanged,
                                   .warningsAsErrors = options_.warningsAsErrors};
        AssetResultAndOutput asset = beginAsset(tasks_[i], policy, limits_);
        results_[i] = std::move(asset.result);
        if (asset.output) outputs_[i] = std::make_unique<PendingOutput>(*std::move(asset.output));
        return results_[i].outcome != Outcome::Failed;
    }

    bool commit(std::size_t i) {
        if (const auto output = std::move(outputs_[i]))
            finishAsset(tasks_[i], std::move(*output), results_[i]);
        return results_[i].outcome != Outcome::Failed;
    }

    void report(std::size_t i) {
        const AssetResult& result = results_[i];
        if (options_.common.json) reporter_.jsonLine(jsonText(assetJson(tasks_[i], result)));
        reporter_.diagnostics(tasks_[i].source, result.diagnostics);
        if (result.error) {
            reporter_.error(*result.error);
            return;
        }
        const bool single = tasks_.size() == 1;
        const bool isNews = result.outcome == Outcome::Converted || result.outcome == Outcome::Kept;
        if (options_.explain || options_.dryRun) {
            // What was asked for is a result. For one file it takes the place of the summary's line.
            if (!single || options_.explain)
                reporter_.result(assetLine(tasks_[i], result, options_.explain) + "\n");
        } else if (!single && (options_.common.verbose || (isNews && !reporter_.showsProgress()))) {
            reporter_.status(assetLine(tasks_[i], result, false));
        }
    }

    void reportUnstarted() {
        if (!options_.common.json) return;
        for (std::size_t i = 0; i < tasks_.size(); ++i) {
            if (results_[i].outcome == Outcome::NotStarted) {
                reporter_.jsonLine(jsonText(assetJson(tasks_[i], results_[i])));
            }
        }
    }

    bool writeDependencies() {
        if (options_.depfile.empty() || options_.dryRun) return true;
        std::vector<DepfileRule> rules;
        for (std::size_t i = 0; i < tasks_.size(); ++i) {
            if (results_[i].outcome == Outcome::Failed || results_[i].outcome == Outcome::NotStarted)
                continue;
            DepfileRule rule{.target = tasks_[i].output, .prerequisites = {tasks_[i].source}};
            if (!options_.settingsFile.empty()) rule.prerequisites.emplace_back(options_.settingsFile);
            rules.push_back(std::move(rule));
        }
        const auto written = writeDepfile(options_.depfile, rules);
        if (!written) reporter_.error(written.error());
        return written.has_value();
    }

    ExitCode exitCode() const {
        std::vector<ErrorCode> failures;
        for (const AssetResult& result : results_) {
            if (result.error) failures.push_back(result.error->code);
        }
        return exitCodeOf(failures, results_.size());
    }

    const ConvertOptions& options_;
    const Limits& limits_;
    Reporter& reporter_;
    std::vector<AssetTask> tasks_;
    std::vector<AssetResult> results_;
    std::vector<std::unique_ptr<PendingOutput>> outputs_;  ///< written, not yet in their places
};

InputQuery inputQuery(const ConvertOptions& options) {
    InputQuery query{.wanted = looksLikeSource, .skippedFolder = {}};
    if (!namesOutputFile(options.output, kPfVoxExtension)) query.skippedFolder = options.output;
    return query;
}

std::vector<AssetTask> makeTasks(const std::vector<InputOutput>& pairs, const SettingsFile& settings,
                                 const ConvertOptions& options) {
    SettingsPatch commandLine = options.patch;
    if (options.archive) commandLine.zstdLevel = kArchiveZstdLevel;
    std::vector<AssetTask> tasks;
    for (const InputOutput& pair : pairs) {
        tasks.push_back({.source = pair.input.file,
                         .output = pair.output,
                         .settings = settings.settingsFor(pair.input.relative, commandLine)});
    }
    return tasks;
}

ExitCode runConvert(const CLI::App& command, const ConvertOptions& options) {
    ReporterSettings reporterSettings = options.common.reporterSettings();
    reporterSettings.warningsAsErrors = options.warningsAsErrors;
    Reporter reporter(reporterSettings);
    const auto stopWith = [&](const Error& error) {
        reporter.error(error);
        return exitCodeOf(error.code);
    };

    const auto limits = parseLimits(options.common.limits);
    if (!limits) return usageError(command, limits.error());
    const auto settings =
        options.settingsFile.empty() ? Result<SettingsFile>() : SettingsFile::load(options.settingsFile);
    if (!settings) return stopWith(settings.error());
    auto inputs = collectInputs(options.inputs, inputQuery(options));
    if (!inputs) return stopWith(inputs.error());
    const auto pairs = pairOutputs(*std::move(inputs), options.output, kPfVoxExtension);
    if (!pairs) return usageError(command, pairs.error());
    if (pairs->empty())
        return stopWith(fail(ErrorCode::NothingToConvert, "no input but outputs of this tool").value());
    return ConvertRun(options, *limits, reporter).run(makeTasks(*pairs, *settings, options));
}

}  // namespace

Command makeConvertCommand(CLI::App& tool) {
    auto options = std::make_shared<ConvertOptions>();
    CLI::App& command = addCommand(tool, "convert", helpText());
    addInputOutputOptions(command, *options);
    addConversionOptions(command, *options);
    addBuildOptions(command, *options);
    addCommonOptions(command, options->common);
    return {.app = &command, .run = [&command, options] { return runConvert(command, *options); }};
}

}  // namespace pfvox::tools
