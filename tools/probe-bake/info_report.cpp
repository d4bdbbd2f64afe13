#include "probe-bake/info_report.hpp"

#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <type_traits>

#include "common/table.hpp"
#include "common/text.hpp"

namespace pfvox::tools {

namespace {

constexpr std::size_t kFewRows = 12;
constexpr std::size_t kIndent = 2;
constexpr std::array kLayers{ProbeLayer::DepthNormal, ProbeLayer::Light, ProbeLayer::MinDepth,
                             ProbeLayer::Irradiance, ProbeLayer::Moments};

template <class Vector>
Json vectorJson(const Vector& v) {
    return {v.x, v.y, v.z};
}

std::string orDash(const std::optional<double>& value) {
    return value ? fmt::format("{:.3f}", *value) : "-";
}

std::vector<LayerSize> layerSizes(const ProbeFileReader& reader) {
    std::vector<LayerSize> sizes;
    const ProbeFieldInfo& field = reader.info();
    for (const ProbeLayer layer : kLayers) {
        if (!field.resolution.has(layer)) continue;
        LayerSize size{.layer = layer};
        for (std::uint32_t probe = field.range.first; probe < field.range.end; ++probe) {
            if (!reader.has(probe, layer)) continue;
            size.storedBytes += reader.frame(probe, layer).storedBytes;
            size.rawBytes += field.resolution.bytesOf(layer);
        }
        sizes.push_back(size);
    }
    return sizes;
}

/// The first error of several threads is kept.
Result<std::vector<ProbeStatistics>> allStatistics(const ProbeFileReader& reader) {
    const ProbeRange range = reader.info().range;
    std::vector<ProbeStatistics> statistics(range.size());
    std::vector<std::optional<Error>> errors(range.size());
    tbb::parallel_for(0u, range.size(), [&](std::uint32_t i) {
        const auto data = reader.readProbe(range.first + i);
        if (data) {
            statistics[i] = statisticsOf(reader.info(), *data);
        } else {
            errors[i] = data.error();
        }
    });
    for (std::optional<Error>& error : errors) {
        if (error) return tl::make_unexpected(*std::move(error));
    }
    return statistics;
}

Json resolutionJson(const ProbeResolution& resolution) {
    return {{"profile", toString(profileOf(resolution))},
            {"depth", resolution.depth},
            {"light", resolution.light},
            {"irradiance", resolution.irradiance},
            {"moments", resolution.moments},
            {"bytesPerProbe", resolution.bytesPerProbe()}};
}

Json lightContentJson(std::uint32_t content) {
    constexpr std::array<std::pair<std::uint32_t, const char*>, 5> kNames{
        {{kLightOfSky, "sky"},
         {kLightOfEmitters, "emitters"},
         {kLightOfBouncedSun, "bounced-sun"},
         {kLightOfDirectSun, "direct-sun"},
         {kLightOfSpecular, "specular"}}};
    Json names = Json::array();
    for (const auto& [bit, name] : kNames) {
        if ((content & bit) != 0) names.push_back(name);
    }
    return names;
}

Json settingsJson(const ProbeBakeSettings& settings) {
    Json json;
    const auto add = [&](const ProbeSetting& setting, const auto& value) {
        if constexpr (std::is_arithmetic_v<std::decay_t<decltype(value)>>) {
            json[std::string(setting.name)] = value;
        } else {
            json[std::string(setting.name)] = value ? Json(*value) : Json(nullptr);
        }
    };
    forEachProbeSetting(add, settings);
    if (settings.maxBounces == kUnlimitedBounces) json["maxBounces"] = "unlimited";
    return json;
}

/// Files of PF_PROBE 1.0 say 0 where it is unknown.
std::optional<double> errorOf(const ProbeFileInfo& info, const ProbeRecord& record) {
    if (!record.error || (info.versionMinor == 0 && *record.error == 0.0f)) return std::nullopt;
    return static_cast<double>(*record.error);
}

Json probeJson(const ProbeFileInfo& info, std::size_t i) {
    const ProbeStatistics& counted = info.probes[i];
    const ProbeRecord& record = info.records[i];
    Json json;
    json["index"] = info.field.range.first + i;
    json["position"] = vectorJson(info.positions[i]);
    json["state"] = toString(record.state);
    json["missFraction"] = orNull(counted.missFraction);
    json["meanIndirect"] = counted.meanIndirect ? vectorJson(*counted.meanIndirect) : Json(nullptr);
    json["maxIndirect"] = orNull(counted.maxIndirect);
    json["minDepth"] = orNull(counted.minDepthMetres);
    json["meanDepth"] = orNull(counted.meanDepthMetres);
    json["error"] = orNull(errorOf(info, record));
    json["noisyTileFraction"] = info.field.settings.isAdaptive() && record.isActive()
                                    ? Json(record.noisyTileFraction)
                                    : Json(nullptr);
    json["hash"] = fmt::format("{:016x}", record.hash);
    return json;
}

std::string probeTable(const ProbeFileInfo& info, std::size_t maxRows) {
    Table table({{"#", Align::Right},
                 {"position, m"},
                 {"state"},
                 {"miss", Align::Right},
                 {"mean indirect"},
                 {"max", Align::Right},
                 {"min depth, m", Align::Right},
                 {"mean", Align::Right},
                 {"error", Align::Right}});
    const std::size_t shown = std::min(info.probes.size(), maxRows);
    for (std::size_t i = 0; i < shown; ++i) {
        const ProbeStatistics& counted = info.probes[i];
        const glm::dvec3 at = info.positions[i];
        const auto& mean = counted.meanIndirect;
        table.addRow({std::to_string(info.field.range.first + i),
                      fmt::format("{:.2f} {:.2f} {:.2f}", at.x, at.y, at.z),
                      std::string(toString(info.records[i].state)),
                      counted.missFraction ? fmt::format("{:.1f} %", 100.0 * *counted.missFraction) : "-",
                      mean ? fmt::format("{:.3f} {:.3f} {:.3f}", mean->x, mean->y, mean->z) : "-",
                      orDash(counted.maxIndirect), orDash(counted.minDepthMetres),
                      orDash(counted.meanDepthMetres),
                      info.records[i].isActive() ? percentText(errorOf(info, info.records[i])) : "-"});
    }
    std::string text = table.render(kIndent);
    if (shown < info.probes.size())
        text += fmt::format("{:{}}... and {} more; -v shows all\n", "", kIndent,
                            formatCount(info.probes.size() - shown));
    return text;
}

std::string layerTable(const ProbeFileInfo& info) {
    Table table({{"layer"},
                 {"resolution", Align::Right},
                 {"stored", Align::Right},
                 {"raw", Align::Right},
                 {"of file", Align::Right}});
    for (const LayerSize& size : info.layers) {
        table.addRow({std::string(toString(size.layer)),
                      std::to_string(info.field.resolution.edgeOf(size.layer)), formatBytes(size.storedBytes),
                      formatBytes(size.rawBytes),
                      fmt::format("{:.1f} %", 100.0 * static_cast<double>(size.storedBytes) /
                                                  static_cast<double>(info.fileBytes))});
    }
    return table.render(kIndent);
}

std::string samplesText(const ProbeBakeSettings& settings) {
    if (!settings.isAdaptive()) return fmt::format("{} paths a texel", settings.minSamples);
    return fmt::format("{} to {} paths a texel until noise is {}", settings.minSamples, settings.maxSamples,
                       percentText(static_cast<double>(settings.noiseTarget)));
}

/// Of the chunks that the file has.
struct FaceTotals {
    std::uint64_t faces = 0;
    std::uint64_t values = 0;
    std::uint64_t storedBytes = 0;
    std::optional<double> noise;  ///< mean over the values of which it is known

    explicit FaceTotals(const FaceLightInfo& info) {
        const std::vector<FaceChunkPlace> places = faceChunkPlaces(info);
        double noiseSum = 0.0;
        double judged = 0.0;
        for (std::uint32_t i = 0; i < info.chunks.size(); ++i) {
            const FaceChunkRecord& chunk = info.chunks[i];
            faces += places[info.range.first + i].faceCount;
            values += chunk.valueCount;
            storedBytes += chunk.storedBytes;
            if (!chunk.noise) continue;
            noiseSum += static_cast<double>(*chunk.noise) * static_cast<double>(chunk.valueCount);
            judged += static_cast<double>(chunk.valueCount);
        }
        if (judged > 0.0) noise = noiseSum / judged;
    }
};

std::string facesText(const FaceLightInfo& info) {
    const FaceTotals totals(info);
    const FaceBakeSettings& settings = info.settings;
    std::string text = fmt::format("  light on {}, {}, {} in {}", plural(totals.faces, "face"),
                                   plural(totals.values, "value"), plural(info.chunks.size(), "chunk"),
                                   formatBytes(totals.storedBytes));
    if (totals.noise) text += ", noise " + percentText(totals.noise);
    return text + fmt::format("\n    {} linked rays a face, {} to {} a value until noise is {}, {}\n",
                              settings.baseRays, settings.minRays, settings.maxRays,
                              percentText(static_cast<double>(settings.noiseTarget)),
                              toString(settings.codec));
}

Json facesJson(const FaceLightInfo& info) {
    const FaceTotals totals(info);
    const FaceBakeSettings& settings = info.settings;
    return {{"faces", totals.faces},
            {"values", totals.values},
            {"instances", info.instances.size()},
            {"chunks", info.chunks.size()},
            {"storedBytes", totals.storedBytes},
            {"noise", orNull(totals.noise)},
            {"settings",
             {{"seed", settings.seed},
              {"baseRays", settings.baseRays},
              {"minRays", settings.minRays},
              {"maxRays", settings.maxRays},
              {"noiseTarget", settings.noiseTarget},
              {"divide", settings.divide},
              {"codec", toString(settings.codec)}}}};
}

std::string headline(const ProbeFileInfo& info) {
    const ProbeFieldInfo& field = info.field;
    const ProbeGrid& grid = field.grid;
    const glm::dvec3 start = grid.worldOf(grid.start);
    const ProbeBakeSettings& settings = field.settings;
    std::string text = fmt::format("PF_PROBE {}.{}, {}, profile {}, content key {}\n", kPfProbeVersionMajor,
                                   info.versionMinor, formatBytes(info.fileBytes),
                                   toString(profileOf(field.resolution)), info.contentKey.hex());
    text += fmt::format("  grid {} x {} x {} from {:.2f} {:.2f} {:.2f} m, step {:.2f} {:.2f} {:.2f} m\n",
                        grid.counts.x, grid.counts.y, grid.counts.z, start.x, start.y, start.z, grid.step.x,
                        grid.step.y, grid.step.z);
    if (!field.isWhole())
        text += fmt::format("  a shard: probes {} to {}\n", field.range.first, field.range.end - 1);
    text += fmt::format("  {}, --seed {}, by {} on {}\n", samplesText(settings), settings.seed,
                        escaped(field.toolName), escaped(field.deviceName));
    text += "  " + probeSettingsText(settings) + "\n";
    if (info.faces) text += facesText(*info.faces);
    if (info.proximityCounts)
        text +=
            fmt::format("  proximity grid {} x {} x {}, {} with probes\n", info.proximityCounts->x,
                        info.proximityCounts->y, info.proximityCounts->z, plural(info.coveredCells, "cell"));
    return text;
}

}  // namespace

Result<ProbeFileInfo> readProbeFileInfo(const std::filesystem::path& file, const Limits& limits,
                                        Diagnostics& diagnostics) {
    PFVOX_TRY(const ProbeFileReader, reader, ProbeFileReader::open(file, limits, diagnostics));
    ProbeFileInfo info{.file = file,
                       .field = reader.info(),
                       .contentKey = reader.contentKey(),
                       .versionMinor = reader.versionMinor(),
                       .fileBytes = reader.fileBytes(),
                       .proximityCounts = {},
                       .faces = reader.faces(),
                       .layers = layerSizes(reader),
                       .records = {},
                       .positions = {},
                       .probes = {}};
    if (const auto& proximity = reader.proximity()) {
        info.proximityCounts = proximity->counts;
        for (std::size_t i = 0; i < proximity->probes.size(); i += kProbesPerCell)
            info.coveredCells += proximity->probes[i] != kNoProbe ? 1u : 0u;
    }
    for (std::uint32_t probe = info.field.range.first; probe < info.field.range.end; ++probe) {
        info.records.push_back(reader.record(probe));
        info.positions.push_back(info.field.grid.worldOf(reader.positionOf(probe)));
    }
    PFVOX_TRY(std::vector<ProbeStatistics>, statistics, allStatistics(reader));
    info.probes = std::move(statistics);
    return info;
}

std::string infoText(const ProbeFileInfo& info, const Reporter& reporter, bool complete) {
    const auto title = [&](std::string_view word, std::size_t count) {
        return "\n" +
               reporter.styled(Reporter::Style::Strong, fmt::format("{} ({})", word, formatCount(count))) +
               "\n";
    };
    std::string text = reporter.styled(Reporter::Style::Strong, info.file.string()) + "\n" + headline(info);
    text += title("Probes", info.probes.size()) + probeTable(info, complete ? info.probes.size() : kFewRows);
    text += "  " + countsText(countProbes(info.records)) + "\n";
    return text + title("Layers", info.layers.size()) + layerTable(info);
}

Json infoJson(const ProbeFileInfo& info) {
    const ProbeFieldInfo& field = info.field;
    Json json;
    json["file"] = info.file.string();
    json["formatVersion"] = fmt::format("{}.{}", kPfProbeVersionMajor, info.versionMinor);
    json["fileBytes"] = info.fileBytes;
    json["contentKey"] = info.contentKey.hex();
    json["grid"] = {{"start", vectorJson(field.grid.worldOf(field.grid.start))},
                    {"step", vectorJson(field.grid.step)},
                    {"counts", vectorJson(field.grid.counts)}};
    json["range"] = {{"first", field.range.first}, {"end", field.range.end}};
    json["resolution"] = resolutionJson(field.resolution);
    json["depthEncoding"] = {{"scale", field.depth.scale}, {"farMetres", field.depth.farMetres}};
    json["lightContent"] = lightContentJson(field.lightContent);
    json["settings"] = settingsJson(field.settings);
    json["sceneHash"] = field.sceneHash.hex();
    json["shaderHash"] = field.shaderHash.hex();
    json["device"] = field.deviceName;
    json["tool"] = field.toolName;
    json["faces"] = info.faces ? facesJson(*info.faces) : Json(nullptr);
    json["proximity"] = Json(nullptr);
    if (info.proximityCounts)
        json["proximity"] = {{"counts", vectorJson(*info.proximityCounts)},
                             {"coveredCells", info.coveredCells}};
    json["states"] = countsJson(countProbes(info.records));
    json["layers"] = Json::array();
    for (const LayerSize& size : info.layers)
        json["layers"].push_back({{"name", toString(size.layer)},
                                  {"resolution", field.resolution.edgeOf(size.layer)},
                                  {"storedBytes", size.storedBytes},
                                  {"rawBytes", size.rawBytes}});
    json["probes"] = Json::array();
    for (std::size_t i = 0; i < info.probes.size(); ++i) json["probes"].push_back(probeJson(info, i));
    return json;
}

}  // namespace pfvox::tools
