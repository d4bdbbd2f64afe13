#include "probe-bake/bake_report.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "common/text.hpp"
#include "probe-bake/probe_statistics.hpp"

namespace pfvox::tools {

namespace {

double raysPerSecond(const BakePass& pass) {
    return pass.gpuMs > 0.0 ? static_cast<double>(pass.rays) / (pass.gpuMs * 1e-3) : 0.0;
}

Json passJson(const BakePass& pass) {
    return {{"rays", pass.rays}, {"gpuMs", pass.gpuMs}};
}

const char* statusOf(const BakeOutcome& outcome) {
    if (outcome.error) return outcome.error->code == ErrorCode::Cancelled ? "interrupted" : "failed";
    return outcome.status == BakeStatus::UpToDate  ? "up-to-date"
           : outcome.status == BakeStatus::Planned ? "planned"
                                                   : "baked";
}

std::string facesText(const FaceReport& faces) {
    std::string text =
        fmt::format("  {}, {} divided, {} in {}", plural(faces.faces, "face"), formatCount(faces.divided),
                    plural(faces.values, "value"), formatBytes(faces.fileBytes));
    if (faces.faces != 0)
        text += fmt::format(" ({:.2f} bytes a face)",
                            static_cast<double>(faces.fileBytes) / static_cast<double>(faces.faces));
    if (faces.reused != 0) return text + "; from the journal\n";
    return text + fmt::format(
                      "\n  {} rays for faces at {} rays/s, {} sweeps, noise {:.2f} %, {:.2f} % of the faces "
                      "stopped at the largest number\n",
                      formatRoughly(static_cast<double>(faces.base.rays + faces.light.rays)),
                      formatRoughly(raysPerSecond({.rays = faces.base.rays + faces.light.rays,
                                                   .gpuMs = faces.base.gpuMs + faces.light.gpuMs})),
                      faces.sweeps, 100.0 * faces.meanNoise, 100.0 * faces.noisyFraction);
}

Json facesJson(const FaceReport& faces) {
    return {{"faces", faces.faces},
            {"reused", faces.reused},
            {"divided", faces.divided},
            {"values", faces.values},
            {"sweeps", faces.sweeps},
            {"meanNoise", faces.meanNoise},
            {"noisyFraction", faces.noisyFraction},
            {"fileBytes", faces.fileBytes},
            {"base", passJson(faces.base)},
            {"light", passJson(faces.light)}};
}

std::string noiseLine(const BakeReport& report) {
    std::string line = "  ";
    if (report.meanSamples) line += fmt::format("{:.1f} paths a texel, ", *report.meanSamples);
    line += "noise " + percentText(report.meanError);
    if (report.maxError) line += fmt::format(" (worst probe {})", percentText(report.maxError));
    if (report.noisyTileFraction)
        line += fmt::format(", {} of the tiles stopped at the largest number",
                            percentText(report.noisyTileFraction));
    return line + "\n";
}

std::string proximityLine(const ProximityReport& proximity) {
    if (proximity.surfaceCells == 0) return {};
    return fmt::format(
        "  proximity grid: {} with surface, {} of them seen by no probe; {:.2f} % of the samples seen\n",
        plural(proximity.surfaceCells, "cell"), formatCount(proximity.uncoveredCells),
        100.0 * static_cast<double>(proximity.seenSamples) /
            static_cast<double>(std::max<std::uint64_t>(proximity.samples, 1)));
}

}  // namespace

std::string progressLine(const std::string& output, const BakeProgress& progress) {
    std::string line = fmt::format("{}: probe {} of {}", output, formatCount(progress.probesDone),
                                   formatCount(progress.probes));
    if (progress.stage == BakeStage::Faces)
        line = fmt::format("{}: light on {}, {} rays", output, plural(progress.faces, "face"),
                           formatRoughly(static_cast<double>(progress.rays)));
    if (progress.probesReused != 0)
        line += fmt::format(" ({} from the journal)", formatCount(progress.probesReused));
    if (progress.elapsedSeconds > 0.0)
        line += fmt::format(", {} rays/s",
                            formatRoughly(static_cast<double>(progress.rays) / progress.elapsedSeconds));
    if (progress.secondsLeft) line += fmt::format(", {} left", formatDuration(*progress.secondsLeft));
    return line;
}

std::string bakeText(const BakeOutcome& outcome, bool explain) {
    const BakeReport& report = outcome.report;
    const std::string reason = escaped(outcome.reason);
    const std::string input = escaped(outcome.input);
    const std::string output = escaped(outcome.output);
    const std::string why = explain || outcome.isRepair ? ": " + reason : "";
    if (outcome.status == BakeStatus::UpToDate) return fmt::format("{} is up to date{}\n", output, why);
    if (outcome.status == BakeStatus::Planned)
        return fmt::format("would bake {} -> {}: {} on {}: {}\n", input, output,
                           plural(report.probes, "probe"), outcome.device, reason);
    std::string text =
        fmt::format("baked {} -> {}: {}, {} in {}{}\n", input, output, plural(report.probes, "probe"),
                    formatBytes(report.fileBytes), formatDuration(report.totalMs * 1e-3), why);
    if (report.faces) text += facesText(*report.faces);
    text += fmt::format("  {}; {} from the journal\n", countsText(report.counts), formatCount(report.reused));
    text += fmt::format("  {} rays for geometry at {} rays/s, {} for light at {} rays/s on {}\n",
                        formatRoughly(static_cast<double>(report.geometry.rays)),
                        formatRoughly(raysPerSecond(report.geometry)),
                        formatRoughly(static_cast<double>(report.light.rays)),
                        formatRoughly(raysPerSecond(report.light)), outcome.device);
    if (report.faces) return text;
    return text + noiseLine(report) + proximityLine(report.proximity);
}

Json bakeJson(const BakeOutcome& outcome) {
    const BakeReport& report = outcome.report;
    const bool isBaked = outcome.status == BakeStatus::Baked && !outcome.error;
    const bool isThere = isBaked || outcome.status == BakeStatus::UpToDate;
    const auto known = [](bool isKnown, Json value) { return isKnown ? std::move(value) : Json(nullptr); };
    Json json;
    json["input"] = outcome.input;
    json["output"] = outcome.output;
    json["status"] = statusOf(outcome);
    json["reason"] = outcome.reason;
    json["contentKey"] = outcome.contentKey ? Json(outcome.contentKey->hex()) : Json(nullptr);
    json["device"] = known(!outcome.device.empty(), outcome.device);
    json["probes"] = known(outcome.status != BakeStatus::Failed, report.probes);
    json["reused"] = known(isBaked, report.reused);
    const Json counts = countsJson(report.counts);
    for (const auto& [name, count] : counts.items()) json[name] = known(isThere, count);
    json["faces"] = report.faces ? facesJson(*report.faces) : Json(nullptr);
    json["geometry"] = known(isBaked, passJson(report.geometry));
    json["light"] = known(isBaked, passJson(report.light));
    json["smallLayersMs"] = known(isBaked, report.smallLayersMs);
    json["proximityMs"] = known(isBaked, report.proximityMs);
    json["writeMs"] = known(isBaked, report.writeMs);
    json["totalMs"] = known(isBaked, report.totalMs);
    json["emitterFaces"] = known(isBaked, report.emitterFaces);
    json["stepLimitRays"] = known(isBaked, report.stepLimitRays);
    json["meanError"] = orNull(report.meanError);
    json["maxError"] = orNull(report.maxError);
    json["noisyTileFraction"] = orNull(report.noisyTileFraction);
    json["meanSamples"] = orNull(report.meanSamples);
    json["surfaceCells"] = known(isBaked, report.proximity.surfaceCells);
    json["uncoveredCells"] = known(isBaked, report.proximity.uncoveredCells);
    json["fileBytes"] = known(isThere, report.fileBytes);
    json["diagnostics"] = toJson(outcome.diagnostics);
    json["error"] = outcome.error ? toJson(*outcome.error) : Json(nullptr);
    return json;
}

std::string deviceLines(std::span<const gpu::DeviceInfo> devices) {
    std::string text;
    for (const gpu::DeviceInfo& device : devices) {
        text += fmt::format("{}  {} ({}, {}), {}{}\n", device.index, device.name, toString(device.kind),
                            formatBytes(device.localMemoryBytes), device.driver,
                            device.usable() ? "" : "; not usable: " + device.missing);
    }
    return text;
}

Json devicesJson(std::span<const gpu::DeviceInfo> devices) {
    Json list = Json::array();
    for (const gpu::DeviceInfo& device : devices)
        list.push_back({{"index", device.index},
                        {"name", device.name},
                        {"kind", toString(device.kind)},
                        {"driver", device.driver},
                        {"localMemoryBytes", device.localMemoryBytes},
                        {"usable", device.usable()},
                        {"missing", device.missing}});
    return {{"devices", list}};
}

}  // namespace pfvox::tools
