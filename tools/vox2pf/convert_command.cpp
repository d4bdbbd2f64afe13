#include <fmt/format.h>

#include <map>
#include <memory>
#include <pfvox/import.hpp>

#include "common/inputs.hpp"
#include "common/output_paths.hpp"
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
    command.add_option("input", options.inputs)
        ->required()
        ->check(suggestFiles(suffixes))
        ->group(group::kInputOutput);
    command.add_option("-o,--output", options.output, "file (.pf_vox) for one input, else folder; required")
        ->option_text("PATH")
        ->required()
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

/// What decides how an asset is built and written.
void addOctreeOptions(CLI::App& command, ConvertOptions& options) {
    SettingsPatch& patch = options.patch;
    const ConvertSettings byDefault;
    addSwitch(command, "hollow", patch.hollow,
              "let voxels that cannot be seen take another material (lossy inside)",
              byDefault.hollow ? "--hollow" : "--no-hollow")
        ->group(group::kConversion);
    addSwitch(command, "lod", patch.lod, "add colors for level of detail, at about twice the size",
              byDefault.build.lod ? "--lod" : "--no-lod")
        ->group(group::kConversion);
    command
        .add_flag(
            "--archive", options.archive,
            fmt::format("compress harder: zstd {} instead of {}", kArchiveZstdLevel, byDefault.zstdLevel))
        ->group(group::kConversion);
    command
        .add_option_function<std::string>(
            "--profile", [&patch](const std::string& name) { patch.profile = parseProfile(name); },
            "packed: small; resident: raw words, nothing to decode")
        ->option_text("NAME")
        ->check(CLI::IsMember({"packed", "resident"}))
        ->check(showDefault(byDefault.profile == Profile::Packed ? "packed" : "resident"))
        ->group(group::kConversion);
}

void addConversionOptions(CLI::App& command, ConvertOptions& options) {
    SettingsPatch& patch = options.patch;
    const ImportSettings byDefault;
    const auto setTrue = [](std::optional<bool>& flag) { return [&flag](std::int64_t) { flag = true; }; };
    command
        .add_option("--settings", options.settingsFile,
                    "TOML file with [import], [build], [encode], [[override]]")
        ->option_text("FILE")
        ->check(suggestFiles({".toml"}))
        ->group(group::kConversion);
    command.add_flag_function("--merge", setTrue(patch.merge), "flatten all instances into one model")
        ->group(group::kConversion);
    command
        .add_flag_function("--include-hidden", setTrue(patch.includeHidden),
                           "keep hidden layers and nodes, visible")
        ->group(group::kConversion);
    command.add_option("--frame", patch.frame, "animation frame, 0 or more")
        ->option_text("N")
        ->check(showDefault(byDefault.frame))
        ->check(numberFrom(0, kMaxFrame))
        ->group(group::kConversion);
    command.add_option("--voxel-size", patch.voxelSizeMetres, "edge of a voxel, 1e-6 to 1e6")
        ->option_text("METERS")
        ->check(showDefault(fmt::format("as in the source, else {}", kDefaultVoxelSizeMetres)))
        ->check(numberFrom(kMinVoxelSizeMetres, kMaxVoxelSizeMetres))
        ->group(group::kConversion);
    command
        .add_option("--svx-threshold", patch.svxThreshold,
                    "SVX: density of a solid voxel, 0 to 1 of the largest")
        ->option_text("FRACTION")
        ->check(showDefault(byDefault.svx.threshold))
        ->check(numberFrom(0.0, 1.0))
        ->group(group::kConversion);
    command
        .add_option("--vdb-grid", patch.vdbGrids,
                    "OpenVDB: import this grid and no others but those named so; may be given again")
        ->option_text("NAME")
        ->group(group::kConversion);
    command
        .add_option("--vdb-threshold", patch.vdbThreshold, "OpenVDB fog: a voxel is solid above this value")
        ->option_text("VALUE")
        ->check(showDefault(byDefault.vdb.threshold))
        ->check(numberFrom(-kMaxVdbThreshold, kMaxVdbThreshold))
        ->group(group::kConversion);
    command.add_option("--vdb-up", patch.vdbUpAxis, "OpenVDB: which axis points up, y or z")
        ->option_text("AXIS")
        ->check(showDefault(byDefault.vdb.upAxis == UpAxis::Y ? "y" : "z"))
        ->transform(CLI::Transformer(std::map<std::string, UpAxis>{{"y", UpAxis::Y}, {"z", UpAxis::Z}}))
        ->group(group::kConversion);
    addOctreeOptions(command, options);
}

void addBuildOptions(CLI::App& command, ConvertOptions& options) {
    command
        .add_option("--depfile", options.depfile, "write what each output was made from, for make and ninja")
        ->option_text("FILE")
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
    // Links are not followed: an asset that is a link has the place of the link.
    const auto named = [](const std::filesystem::path& path) {
        const auto name = std::filesystem::absolute(path).lexically_normal();
        return name.has_filename() ? name : name.parent_path();
    };
    for (InputFile& input : inputs) {
        if (input.fromFolder) continue;
        const auto relative = named(input.file).lexically_relative(named(baseDir));
        if (relative.empty() || relative == "." || *relative.begin() == "..")
            return input.file.string() + " is not below --base-dir " + baseDir.string();
        input.relative = relative;
    }
    return {};
}

/// Scenes are carried over under their own name. In folders the name tells them from settings files; what is
/// named on the command line is a scene by its extension.
bool isScene(const InputFile& input) {
    return input.fromFolder ? isSceneName(input.file) : input.file.extension() == ".toml";
}

std::vector<AssetTask> makeTasks(const std::vector<InputOutput>& pairs, const SettingsFile& settings,
                                 const ConvertOptions& options) {
    SettingsPatch commandLine = options.patch;
    if (options.archive) commandLine.zstdLevel = kArchiveZstdLevel;
    std::vector<AssetTask> tasks;
    for (const InputOutput& pair : pairs) {
        tasks.push_back({.source = pair.input.file,
                         .output = pair.output,
                         .settings = settings.settingsFor(pair.input.relative, commandLine),
                         .isScene = isScene(pair.input),
                         .fault = pair.input.fault});
    }
    return tasks;
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
