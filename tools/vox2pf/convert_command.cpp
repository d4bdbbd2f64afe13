#include <fmt/format.h>

#include <memory>
#include <pfvox/import.hpp>
#include <set>
#include <type_traits>

#include "common/inputs.hpp"
#include "common/output_paths.hpp"
#include "common/paths.hpp"
#include "vox2pf/commands.hpp"
#include "vox2pf/convert_run.hpp"

namespace pfvox::tools {

namespace {

HelpText helpText() {
    return {
        .summary =
            "Converts voxel sources to PF_VOX files and carries scenes over. What is up to date by its "
            "content is left "
            "alone.",
        .usage = {"vox2pf [convert] [options] <file | folder | @list | ->... -o <file | folder>",
                  "  @list is a text file with one input a line, - is such a list on stdin"},
        .examples = {{"vox2pf hall.vox -o hall.pf_vox", "one file"},
                     {"vox2pf assets -o build/assets -j 4", "a folder with its subfolders, on 4 threads"},
                     {"vox2pf assets -o build/assets --dry-run --explain", "what would be done, and why"}}};
}

void addInputOutputOptions(CLI::App& command, ConvertOptions& options) {
    std::vector<std::string> suffixes{".toml"};
    for (const SourceFormat& format : sourceFormats()) suffixes.emplace_back(format.extension);
    addInputs(command, options.inputs, suffixes);
    command.add_option("-o,--output", options.output, "file (.pf_vox) for one input, else folder; required")
        ->option_text("PATH")
        ->required()
        ->check(outputPath())
        ->check(suggestFiles({kPfVoxExtension}))
        ->group(group::kInputOutput);
    command
        .add_option("--base-dir", options.baseDir,
                    "files named on the command line are mirrored from this folder, as if it were the input")
        ->option_text("FOLDER")
        ->group(group::kInputOutput);
    auto* force =
        command
            .add_flag("--force", options.force, "convert what is up to date, too; replace read-only outputs")
            ->group(group::kInputOutput);
    command.add_flag("--no-clobber", options.noClobber, "never replace an existing output")
        ->excludes(force)
        ->group(group::kInputOutput);
    command.add_flag("--dry-run", options.dryRun, "write nothing, say what would be written")
        ->group(group::kInputOutput);
    command.add_flag("--explain", options.explain, "say of every file why it is converted or not")
        ->group(group::kInputOutput);
}

// One option of the table for a field of each type; what it holds without the option is shown in help.

CLI::Option* addSetting(CLI::App& command, const ConvertSetting& setting, bool& field, SettingsPatch& patch) {
    const std::string name(setting.option);
    return addSwitch(
        command, name, [&, key = setting.key](bool on) { patch.give(key, field, on); },
        std::string(setting.meaning), (field ? "--" : "--no-") + name);
}

template <class T>
requires std::is_arithmetic_v<T> CLI::Option* addSetting(CLI::App& command, const ConvertSetting& setting,
                                                         T& field, SettingsPatch& patch) {
    return command
        .add_option_function<T>(
            fmt::format("--{}", setting.option),
            [&, setting](const T& value) { patch.give(setting.key, field, value); },
            std::string(setting.meaning))
        ->check(showDefault(field))
        ->check(numberFrom(setting.low, setting.high));
}

CLI::Option* addSetting(CLI::App& command, const ConvertSetting& setting, std::optional<double>& field,
                        SettingsPatch& patch) {
    return command
        .add_option_function<double>(
            fmt::format("--{}", setting.option),
            [&, setting](double value) { patch.give(setting.key, field, std::optional(value)); },
            std::string(setting.meaning))
        ->check(showDefault(fmt::format("as in the source, else {}", kDefaultVoxelSizeMetres)))
        ->check(numberFrom(setting.low, setting.high));
}

CLI::Option* addSetting(CLI::App& command, const ConvertSetting& setting, std::vector<std::string>& field,
                        SettingsPatch& patch) {
    return command
        .add_option_function<std::vector<std::string>>(
            fmt::format("--{}", setting.option),
            [&, setting](const std::vector<std::string>& names) { patch.give(setting.key, field, names); },
            std::string(setting.meaning))
        ->expected(1)
        ->take_all()
        ->allow_extra_args(false);
}

template <class Enum>
requires std::is_enum_v<Enum> CLI::Option* addSetting(CLI::App& command, const ConvertSetting& setting,
                                                      Enum& field, SettingsPatch& patch) {
    const std::set<std::string> names(setting.choices.begin(), setting.choices.end());
    return command
        .add_option_function<std::string>(
            fmt::format("--{}", setting.option),
            [&, setting](const std::string& name) {
                patch.give(setting.key, field, choiceOf<Enum>(setting, name).value_or(field));
            },
            std::string(setting.meaning))
        ->check(CLI::IsMember(names))
        ->check(showDefault(std::string(setting.choices[static_cast<std::size_t>(field)])));
}

void addConversionOptions(CLI::App& command, ConvertOptions& options) {
    command
        .add_option("--settings", options.settingsFile,
                    "TOML file with [import], [build], [encode], [[override]]")
        ->option_text("FILE")
        ->check(suggestFiles({".toml"}))
        ->group(group::kConversion);
    forEachConvertSetting(
        [&](const ConvertSetting& setting, auto& field) {
            CLI::Option* const option = addSetting(command, setting, field, options.patch);
            if (!setting.value.empty()) option->option_text(std::string(setting.value));
            option->group(group::kConversion);
        },
        options.patch.values);
    command
        .add_flag("--archive", options.archive,
                  fmt::format("compress harder: --zstd-level {}", kArchiveZstdLevel))
        ->group(group::kConversion);
}

void addBuildOptions(CLI::App& command, ConvertOptions& options) {
    command
        .add_option("--depfile", options.depfile, "write what each output was made from, for make and ninja")
        ->option_text("FILE")
        ->check(outputPath())
        ->check(suggestFiles({".d"}))
        ->group(group::kBuild);
    command
        .add_flag("--if-changed", options.ifChanged,
                  "keep the time stamp of outputs that stay the same (ninja)")
        ->group(group::kBuild);
    command.add_flag("--fail-fast", options.failFast, "start no further file after a failure")
        ->group(group::kBuild);
    command.add_flag("--no-summary", options.noSummary, "print nothing but warnings and errors, for builds")
        ->group(group::kBuild);
    command
        .add_flag("--warnings-as-errors", options.warningsAsErrors,
                  "a file with warnings fails, nothing is written")
        ->group(group::kBuild);
}

InputQuery inputQuery(const ConvertOptions& options) {
    const auto wanted = [](const std::filesystem::path& file) {
        return looksLikeSource(file) || isSceneName(file);
    };
    InputQuery query{.wanted = wanted, .skippedFolder = {}};
    if (!namesOutputFile(options.output, kPfVoxExtension)) query.skippedFolder = options.output;
    return query;
}

/// --base-dir: files that were named one by one keep their place below that folder. Gives what is wrong, if
/// anything.
std::string placeBelow(const std::filesystem::path& baseDir, std::vector<InputFile>& inputs) {
    for (InputFile& input : inputs) {
        if (input.fromFolder) continue;
        const auto relative = placeOf(input.file).lexically_relative(placeOf(baseDir));
        if (relative.empty() || relative == "." || *relative.begin() == "..")
            return input.file.string() + " is not below --base-dir " + baseDir.string();
        input.relative = relative;
    }
    return {};
}

/// Scenes are carried over under their own name. In folders the name tells them from settings files; what is
/// named on the command line is a scene by its extension.
bool isScene(const InputFile& input) {
    return input.fromFolder ? isSceneName(input.file) : hasExtension(input.file, ".toml");
}

std::vector<AssetTask> makeTasks(const std::vector<InputOutput>& pairs, const SettingsFile& settings,
                                 const ConvertOptions& options) {
    SettingsPatch commandLine = options.patch;
    if (options.archive) commandLine.give("zstdLevel", commandLine.values.zstdLevel, kArchiveZstdLevel);
    std::vector<AssetTask> tasks;
    tasks.reserve(pairs.size());
    for (const InputOutput& pair : pairs) {
        tasks.push_back({.source = pair.input.file,
                         .output = pair.output,
                         .settings = settings.settingsFor(pair.input.relative, commandLine),
                         .isScene = isScene(pair.input),
                         .fault = pair.input.fault});
    }
    return tasks;
}

/// A pattern that nothing fits, and something would in other letters, is a mistake.
void warnAboutPatterns(const SettingsFile& settings, const std::vector<InputOutput>& pairs,
                       const std::string& settingsFile, Reporter& reporter) {
    std::vector<std::filesystem::path> inputs;
    for (const InputOutput& pair : pairs) inputs.push_back(pair.input.relative);
    DiagnosticList diagnostics;
    settings.reportNearMisses(inputs, diagnostics);
    reporter.diagnostics(settingsFile, diagnostics.entries());
}

ExitCode runConvert(const CLI::App& command, const ConvertOptions& options) {
    ReporterSettings reporterSettings = options.common.reporterSettings();
    reporterSettings.warningsAsErrors = options.warningsAsErrors;
    if (options.noSummary && reporterSettings.verbosity == Verbosity::Normal)
        reporterSettings.verbosity = Verbosity::Warnings;
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
    DiagnosticList leftOut;
    auto inputs = collectInputs(options.inputs, inputQuery(options), leftOut);
    reporter.diagnostics({}, leftOut.entries());
    if (!inputs) return stopWith(inputs.error());
    if (!options.baseDir.empty()) {
        if (const std::string complaint = placeBelow(options.baseDir, *inputs); !complaint.empty())
            return usageError(command, complaint);
    }
    const auto pairs = pairOutputs(*std::move(inputs), options.output, kPfVoxExtension, isScene);
    if (!pairs) return usageError(command, pairs.error());
    if (pairs->empty())
        return stopWith(fail(ErrorCode::NothingToConvert, "no input but outputs of this tool").value());
    warnAboutPatterns(*settings, *pairs, options.settingsFile, reporter);
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
