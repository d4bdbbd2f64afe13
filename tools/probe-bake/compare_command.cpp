#include <fmt/format.h>

#include <memory>

#include "common/json.hpp"
#include "common/table.hpp"
#include "common/text.hpp"
#include "probe-bake/commands.hpp"
#include "probe-bake/compare_fields.hpp"
#include "probe-bake/probe_statistics.hpp"

namespace pfvox::tools {

namespace {

constexpr std::size_t kFewProbes = 10;

struct CompareOptions {
    CommonOptions common;
    std::vector<std::string> files;
    std::optional<double> minPsnr;
    std::optional<double> minWithinOne;
    bool requireEqual = false;
};

HelpText helpText() {
    return {
        .summary =
            "Compares two PF_PROBE files of one grid, layer by layer. Exit code 1 if they are further apart "
            "than the options allow.",
        .usage = {"probe-bake compare [options] <a.pf_probe> <b.pf_probe>"},
        .examples = {
            {"probe-bake compare a.pf_probe b.pf_probe", "how far they are apart"},
            {"probe-bake compare --equal a.pf_probe b.pf_probe", "fails unless all probes are equal"},
            {"probe-bake compare --min-psnr 45 a.pf_probe b.pf_probe", "fails below 45 dB"}}};
}

std::string differenceText(const FieldDifference& difference) {
    std::string text = fmt::format("{} of {} equal\n", formatCount(difference.equalProbes),
                                   plural(difference.probes, "probe"));
    for (const std::string& name : difference.differentSettings) text += "  baked with " + name + "\n";
    if (!difference.differentRecords.empty()) {
        text += fmt::format("  {} in another state or place:",
                            plural(difference.differentRecords.size(), "probe"));
        for (std::size_t i = 0; i < std::min(kFewProbes, difference.differentRecords.size()); ++i)
            text += fmt::format(" {}", difference.differentRecords[i]);
        text += difference.differentRecords.size() > kFewProbes ? " ...\n" : "\n";
    }
    Table table({{"layer"},
                 {"words", Align::Right},
                 {"different", Align::Right},
                 {"largest", Align::Right},
                 {"at probe", Align::Right},
                 {"PSNR, dB", Align::Right},
                 {"within 1 code", Align::Right},
                 {"normals, degrees", Align::Right}});
    for (const LayerDifference& layer : difference.layers) {
        const bool light = layer.layer == ProbeLayer::Light || layer.layer == ProbeLayer::Irradiance;
        table.addRow(
            {std::string(toString(layer.layer)), formatCount(layer.words), formatCount(layer.differentWords),
             fmt::format("{:.4g}", layer.largest),
             layer.largestProbe == kNoProbe ? "-" : std::to_string(layer.largestProbe),
             !light || layer.words == 0 ? "-"
             : layer.psnrDecibel        ? fmt::format("{:.2f}", *layer.psnrDecibel)
                                        : "inf",
             layer.withinOneFraction ? fmt::format("{:.3f} %", 100.0 * *layer.withinOneFraction) : "-",
             layer.layer == ProbeLayer::DepthNormal ? fmt::format("{:.2f}", layer.largestNormalDegrees)
                                                    : "-"});
    }
    return text + table.render(2);
}

Json differenceJson(const CompareOptions& options, const FieldDifference& difference) {
    Json json;
    json["files"] = options.files;
    json["equal"] = difference.equal();
    json["probes"] = difference.probes;
    json["equalProbes"] = difference.equalProbes;
    json["differentRecords"] = difference.differentRecords;
    json["differentSettings"] = difference.differentSettings;
    json["layers"] = Json::array();
    for (const LayerDifference& layer : difference.layers)
        json["layers"].push_back(
            {{"name", toString(layer.layer)},
             {"words", layer.words},
             {"differentWords", layer.differentWords},
             {"largest", layer.largest},
             {"largestProbe", layer.largestProbe == kNoProbe ? Json(nullptr) : Json(layer.largestProbe)},
             {"psnrDecibel", orNull(layer.psnrDecibel)},
             {"withinOneFraction", orNull(layer.withinOneFraction)},
             {"largestNormalDegrees", layer.largestNormalDegrees}});
    return json;
}

/// Why the files are too far apart; empty = they are not.
std::string complaint(const CompareOptions& options, const FieldDifference& difference) {
    if (options.requireEqual && !difference.equal())
        return plural(difference.probes - difference.equalProbes, "probe") + " differ";
    for (const LayerDifference& layer : difference.layers) {
        if (options.minPsnr && layer.psnrDecibel && *layer.psnrDecibel < *options.minPsnr)
            return fmt::format("layer {}: {:.2f} dB", toString(layer.layer), *layer.psnrDecibel);
        if (options.minWithinOne && layer.withinOneFraction &&
            100.0 * *layer.withinOneFraction < *options.minWithinOne)
            return fmt::format("layer {}: {:.3f} % of the codes within 1", toString(layer.layer),
                               100.0 * *layer.withinOneFraction);
        if ((options.minPsnr || options.minWithinOne) && layer.words == 0 && !difference.equal())
            return fmt::format("layer {}: no probe is active in both", toString(layer.layer));
    }
    return {};
}

ExitCode runCompare(const CLI::App& command, const CompareOptions& options) {
    Reporter reporter(options.common.reporterSettings());
    const auto limits = parseLimits(options.common.limits);
    if (!limits) return usageError(command, limits.error());
    if (options.files.size() != 2)
        return usageError(command, "two files are compared, and only one was named");
    const auto stopWith = [&](const Error& error) {
        reporter.error(error);
        return exitCodeOf(error.code);
    };
    DiagnosticList diagnostics;
    const auto first = ProbeFileReader::open(options.files[0], *limits, diagnostics);
    if (!first) return stopWith(first.error());
    const auto second = ProbeFileReader::open(options.files[1], *limits, diagnostics);
    if (!second) return stopWith(second.error());
    auto difference = compareFields(*first, *second);
    if (!difference) {
        if (difference.error().file.empty()) difference.error().file = options.files[1];
        return stopWith(difference.error());
    }
    if (options.common.json) reporter.jsonLine(jsonText(differenceJson(options, *difference)));
    reporter.result(differenceText(*difference));
    const std::string tooFar = complaint(options, *difference);
    if (tooFar.empty()) return ExitCode::Ok;
    reporter.error("the files are further apart than asked for: " + tooFar);
    return ExitCode::SomeFailed;
}

}  // namespace

Command makeCompareCommand(CLI::App& tool) {
    auto options = std::make_shared<CompareOptions>();
    CLI::App& command = addCommand(tool, "compare", helpText());
    command.add_option("input", options->files)
        ->required()
        ->expected(1, 2)
        ->check(suggestFiles({kPfProbeExtension}))
        ->group(group::kInputOutput);
    command.add_flag("--equal", options->requireEqual, "fail unless the hashes of all probes are equal")
        ->group(group::kInputOutput);
    command
        .add_option("--min-psnr", options->minPsnr,
                    "fail when the light of a layer is further apart, dB, 0 to 200")
        ->option_text("DB")
        ->check(numberFrom(0, 200))
        ->group(group::kInputOutput);
    command
        .add_option("--min-depth-within-one", options->minWithinOne,
                    "fail when fewer depth codes are at most one apart, percent")
        ->option_text("PERCENT")
        ->check(numberFrom(0, 100))
        ->group(group::kInputOutput);
    addCommonOptions(command, options->common);
    return {.app = &command, .run = [&command, options] { return runCompare(command, *options); }};
}

}  // namespace pfvox::tools
