#include <fmt/format.h>

#include <memory>
#include <pfvox/files.hpp>
#include <pfvox/probe_file.hpp>
#include <pfvox/shard_proximity.hpp>

#include "common/file_visit.hpp"
#include "common/inputs.hpp"
#include "common/json.hpp"
#include "common/paths.hpp"
#include "common/text.hpp"
#include "probe-bake/commands.hpp"

namespace pfvox::tools {

namespace {

struct MergeOptions : ReadOptions {
    std::string output;
    std::string scene;
    bool allowPart = false;
};

HelpText helpText() {
    return {
        .summary = "Joins the shards of a bake, in any order, to the file that one bake would have written.",
        .usage = {"probe-bake merge [options] <shard.pf_probe | folder | @list | ->... -o <file.pf_probe>"},
        .examples = {{"probe-bake merge a.pf_probe b.pf_probe -o hall.pf_probe", "two shards"},
                     {"probe-bake merge shards -o hall.pf_probe --scene hall.toml",
                      "a folder of them; with the proximity grid"}}};
}

/// The content key that all shards share; none when they differ, or when the result lacks the proximity grid
/// that a bake would have made: it must not count as up to date.
ContentKey commonKey(const std::vector<std::filesystem::path>& shards, bool withProximity,
                     const Limits& limits) {
    std::optional<ContentKey> common;
    for (const std::filesystem::path& shard : shards) {
        DiagnosticList ignored;  // the merge reports them
        const auto reader = ProbeFileReader::open(shard, limits, ignored);
        if (!reader || (!withProximity && reader->info().resolution.depth != 0) ||
            (common && *common != reader->contentKey()))
            return {};
        common = reader->contentKey();
    }
    return common.value_or(ContentKey{});
}

/// The proximity grid, which shards cannot have: from the scene they were baked from. None without a scene or
/// depth maps, and none when probes are missing or doubled, which the merge reports.
Result<std::optional<ProximityGrid>> proximityFor(const MergeOptions& options,
                                                  const std::vector<std::filesystem::path>& files,
                                                  const Limits& limits, DiagnosticList& diagnostics) {
    if (options.scene.empty()) return std::nullopt;
    PFVOX_TRY(const LoadedScene, scene, loadScene(options.scene, limits, diagnostics));
    std::vector<ProbeFileReader> shards;
    for (const std::filesystem::path& file : files) {
        DiagnosticList ignored;  // the merge reports them
        PFVOX_TRY(ProbeFileReader, reader, ProbeFileReader::open(file, limits, ignored));
        shards.push_back(std::move(reader));
    }
    if (!isWholeGrid(shards) || shards.front().info().resolution.depth == 0) return std::nullopt;
    auto built = proximityOfShards(scene, shards);
    if (!built) {
        built.error().file = options.scene;
        return tl::make_unexpected(std::move(built).error());
    }
    return std::move(built->grid);
}

ExitCode runMerge(const CLI::App& command, const MergeOptions& options) {
    Reporter reporter(options.common.reporterSettings());
    const auto limits = parseLimits(options.common.limits);
    if (!limits) return usageError(command, limits.error());
    const auto stopWith = [&](const Error& error) {
        reporter.error(error);
        return exitCodeOf(error.code);
    };
    const auto wanted = [](const std::filesystem::path& file) {
        return hasExtension(file, kPfProbeExtension);
    };
    DiagnosticList diagnostics;
    const auto inputs = collectInputs(options.inputs, {.wanted = wanted, .skippedFolder = {}}, diagnostics);
    if (!inputs) return stopWith(inputs.error());
    std::vector<std::filesystem::path> shards;
    for (const InputFile& input : *inputs) {
        if (input.fault) return stopWith(*input.fault);
        if (canonicalName(input.file) == canonicalName(options.output))
            return usageError(command, options.output + " is both a shard and the output");
        shards.push_back(input.file);
    }

    const auto proximity = proximityFor(options, shards, *limits, diagnostics);
    if (!proximity) return stopWith(proximity.error());
    const ProbeMergeSettings settings{.contentKey = commonKey(shards, proximity->has_value(), *limits),
                                      .proximity = *proximity,
                                      .allowPart = options.allowPart};
    const auto merged = mergeProbeFields(shards, options.output, settings, *limits, diagnostics);
    reporter.diagnostics(options.output, diagnostics.entries());
    if (!merged) return stopWith(merged.error());
    if (options.common.json)
        reporter.jsonLine(jsonText(Json{{"output", options.output}, {"shards", shards.size()}}));
    reporter.result(
        fmt::format("merged {} into {}\n", plural(shards.size(), "shard"), escaped(options.output)));
    return ExitCode::Ok;
}

}  // namespace

Command makeMergeCommand(CLI::App& tool) {
    auto options = std::make_shared<MergeOptions>();
    CLI::App& command = addCommand(tool, "merge", helpText());
    command.add_option("-o,--output", options->output, "the joined file; required")
        ->option_text("FILE")
        ->required()
        ->check(outputPath())
        ->check(suggestFiles({kPfProbeExtension}))
        ->group(group::kInputOutput);
    command
        .add_option("--scene", options->scene,
                    "what was baked: makes the proximity grid, which shards cannot have")
        ->option_text("SCENE")
        ->check(suggestFiles({".toml", ".pf_vox"}))
        ->group(group::kInputOutput);
    command.add_flag("--allow-part", options->allowPart, "the shards need not make up the whole grid")
        ->group(group::kInputOutput);
    addReadOptions(command, *options, kPfProbeExtension);
    return {.app = &command, .run = [&command, options] { return runMerge(command, *options); }};
}

}  // namespace pfvox::tools
