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

std::string contentText(const AssetTask& task, const ConvertReport& report) {
    if (task.isScene)
        return fmt::format("scene of {}, {}", plural(report.models, "model"),
                           formatBytes(report.outputBytes));
    std::string text = fmt::format("{}, {}, {}", plural(report.models, "model"),
                                   plural(report.voxels, "voxel"), formatBytes(report.outputBytes));
    if (report.hollowedVoxels > 0) text += fmt::format(", {} hollowed", formatCount(report.hollowedVoxels));
    if (report.voxels > 0) {
        text += fmt::format(" ({:.3f} bytes/voxel)",
                            static_cast<double>(report.outputBytes) / static_cast<double>(report.voxels));
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
        sourceBytes += result.report.sourceBytes;
        outputBytes += result.report.outputBytes;
        voxels += result.report.voxels;
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
    if (result.outcome == Outcome::Converted) text += ": " + contentText(task, result.report);
    if (explain && !result.reason.empty()) text += fmt::format("; {}", result.reason);
    return text;
}

Json assetJson(const AssetTask& task, const AssetResult& result) {
    const ConvertReport& report = result.report;
    Json json;
    json["kind"] = task.isScene ? "scene" : "asset";
    json["source"] = task.source.string();
    json["output"] = task.output.string();
    json["status"] = toString(result.outcome);
    json["reason"] = result.reason;
    json["sourceBytes"] = report.sourceBytes;
    json["outputBytes"] = report.outputBytes;
    json["models"] = report.models;
    json["instances"] = report.instances;
    json["materials"] = report.materials;
    json["voxels"] = report.voxels;
    json["hollowedVoxels"] = report.hollowedVoxels;
    json["nodes"] = report.nodes;
    json["leaves"] = report.leaves;
    json["seconds"] = {{"import", report.importSeconds},
                       {"build", report.buildSeconds},
                       {"encode", report.encodeSeconds},
                       {"write", report.writeSeconds}};
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
