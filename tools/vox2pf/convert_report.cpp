#include "vox2pf/convert_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "common/table.hpp"
#include "common/text.hpp"

namespace pfvox::tools {

namespace {

/// How people read an outcome; the JSON spelling has hyphens.
std::string_view words(Outcome outcome) {
    switch (outcome) {
        case Outcome::UpToDate:
            return "up to date";
        case Outcome::Kept:
            return "kept (--no-clobber)";
        case Outcome::Planned:
            return "would convert";
        case Outcome::NotStarted:
            return "not started";
        default:
            return toString(outcome);
    }
}

std::string contentText(const AssetResult& result) {
    const std::uint64_t bytes = result.outputBytes.value_or(0);
    if (result.sceneModels)
        return fmt::format("scene of {}, {}", plural(*result.sceneModels, "model"), formatBytes(bytes));
    const ConvertReport report = result.conversion.value_or(ConvertReport{});
    std::string text = fmt::format("{}, {}, {}", plural(report.models, "model"),
                                   plural(report.voxels, "voxel"), formatBytes(bytes));
    if (report.hollowedVoxels > 0) text += fmt::format(", {} hollowed", formatCount(report.hollowedVoxels));
    if (report.voxels > 0) {
        text += fmt::format(" ({:.3f} bytes/voxel)",
                            static_cast<double>(bytes) / static_cast<double>(report.voxels));
    }
    return text;
}

struct Totals {
    std::size_t files = 0;
    std::size_t warnings = 0;
    std::uint64_t sourceBytes = 0;
    std::uint64_t outputBytes = 0;
    std::uint64_t voxels = 0;

    void add(const AssetResult& result) {
        ++files;
        warnings += Reporter::warningCount(result.diagnostics);
        sourceBytes += result.sourceBytes.value_or(0);
        outputBytes += result.outputBytes.value_or(0);
        if (result.conversion) voxels += result.conversion->voxels;
    }
};

/// "warning" counts and voxel rate below the table.
std::string closingLine(const Totals& converted, std::size_t warnings, double seconds) {
    std::string text = fmt::format("{}", formatDuration(seconds));
    if (converted.voxels > 0 && seconds > 0.0) {
        text += fmt::format(", {} voxels/s", formatRoughly(static_cast<double>(converted.voxels) / seconds));
    }
    if (warnings > 0) text += ", " + plural(warnings, "warning");
    return text + "\n";
}

}  // namespace

std::string assetLine(const AssetTask& task, const AssetResult& result, bool explain) {
    std::string text = fmt::format("{} {} -> {}", words(result.outcome), escaped(task.source.string()),
                                   escaped(task.output.string()));
    if (result.outcome == Outcome::Converted) text += ": " + contentText(result);
    if ((explain || result.isRepair) && !result.reason.empty())
        text += fmt::format("; {}", escaped(result.reason));
    return text;
}

Json assetJson(const AssetTask& task, const AssetResult& result) {
    const auto orNull = [](const auto& known) { return known ? Json(*known) : Json(nullptr); };
    const auto of = [](const std::optional<ConvertReport>& report, auto field) {
        return report ? Json((*report).*field) : Json(nullptr);
    };
    using Report = ConvertReport;
    Json json;
    json["kind"] = task.isScene ? "scene" : "asset";
    json["source"] = task.source.string();
    json["output"] = task.output.string();
    json["status"] = toString(result.outcome);
    json["reason"] = result.reason;
    json["sourceBytes"] = orNull(result.sourceBytes);
    json["outputBytes"] = orNull(result.outputBytes);
    json["models"] = task.isScene ? orNull(result.sceneModels) : of(result.counts, &Report::models);
    json["instances"] = of(result.counts, &Report::instances);
    json["materials"] = of(result.counts, &Report::materials);
    json["voxels"] = of(result.counts, &Report::voxels);
    json["hollowedVoxels"] = of(result.conversion, &Report::hollowedVoxels);
    json["nodes"] = of(result.counts, &Report::nodes);
    json["leaves"] = of(result.counts, &Report::leaves);
    json["seconds"] = {{"import", of(result.conversion, &Report::importSeconds)},
                       {"build", of(result.conversion, &Report::buildSeconds)},
                       {"encode", of(result.conversion, &Report::encodeSeconds)},
                       {"write", of(result.conversion, &Report::writeSeconds)}};
    json["diagnostics"] = toJson(result.diagnostics);
    json["error"] = result.error ? toJson(*result.error) : Json(nullptr);
    return json;
}

std::string summary(std::span<const AssetTask> tasks, std::span<const AssetResult> results, double seconds) {
    if (tasks.size() == 1) {
        const AssetResult& result = results.front();
        if (result.outcome == Outcome::Failed) return {};  // the error was the answer
        return assetLine(tasks.front(), result, false) + "\n";
    }
    constexpr std::array kOrder{Outcome::Converted, Outcome::UpToDate, Outcome::Planned,
                                Outcome::Kept,      Outcome::Failed,   Outcome::NotStarted};
    Table table({{""},
                 {"files", Align::Right},
                 {"source", Align::Right},
                 {"output", Align::Right},
                 {"voxels", Align::Right}});
    Totals converted;
    std::size_t warnings = 0;
    for (const Outcome outcome : kOrder) {
        Totals totals;
        for (const AssetResult& result : results) {
            if (result.outcome == outcome) totals.add(result);
        }
        warnings += totals.warnings;
        if (outcome == Outcome::Converted) converted = totals;
        if (totals.files == 0 && outcome != Outcome::Converted) continue;
        const bool hasContent = outcome == Outcome::Converted && totals.files > 0;
        table.addRow({std::string(words(outcome)), formatCount(totals.files),
                      totals.sourceBytes > 0 ? formatBytes(totals.sourceBytes) : "",
                      hasContent ? formatBytes(totals.outputBytes) : "",
                      hasContent ? formatCount(totals.voxels) : ""});
    }
    const bool idle =
        std::ranges::all_of(results, [](const AssetResult& r) { return r.outcome == Outcome::UpToDate; });
    if (idle) {
        return fmt::format("nothing to do: all {} are up to date ({})\n", plural(results.size(), "file"),
                           formatDuration(seconds));
    }
    return table.render() + closingLine(converted, warnings, seconds);
}

}  // namespace pfvox::tools
