#include "result_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <optional>
#include <sstream>
#include <stdexcept>

namespace pfvox::bench {

namespace {

using Json = nlohmann::ordered_json;
using Cells = std::vector<std::string>;

constexpr const char* kBegin = "\n<!-- table ";  // at the start of a line
constexpr const char* kBeginEnds = " -->";
constexpr const char* kEnd = "<!-- end of table -->\n";

std::string rowOf(const Cells& cells) {
    return fmt::format("| {} |\n", fmt::join(cells, " | "));
}

/// The first `leftAligned` columns are text, the others numbers.
std::string headOf(const Cells& titles, std::size_t leftAligned) {
    Cells rules(titles.size(), "---:");
    std::fill_n(rules.begin(), leftAligned, "---");
    return rowOf(titles) + rowOf(rules);
}

std::string countText(std::uint64_t count) {
    std::string text = std::to_string(count);
    for (auto at = static_cast<std::ptrdiff_t>(text.size()) - 3; at > 0; at -= 3)
        text.insert(static_cast<std::size_t>(at), ",");
    return text;
}

std::string percent(double fraction) {
    return fmt::format("{:.1f} %", 100.0 * fraction);
}

// ---- Verify: bench/run-verify ----

std::string verifyRow(const Json& line) {
    const Json& score = line.at("verify");
    const Json& all = score.at("all");
    const Json& reference = score.at("reference");
    const bool hasTexels = score.at("byTier").contains("texels");
    const auto texels = [&](double fraction) { return hasTexels ? percent(fraction) : std::string(); };
    const std::string doubt = reference.at("isCertain").get<bool>() ? "" : " ?";
    return rowOf(
        {fmt::format("{}, {}", line.at("scene").get<std::string>(), score.at("camera").get<std::string>()),
         line.at("profile").get<std::string>(),
         countText(static_cast<std::uint64_t>(std::lround(line.at("bake").at("meanSamples").get<double>()))),
         fmt::format("{:.1f}", 1e-3 * line.at("bake").at("totalMs").get<double>()),
         fmt::format("{:.1f}", 1e-6 * line.at("fileBytes").get<double>()),
         texels(score.at("tierFractions").at("texels").get<double>()),
         percent(all.at("relativeRmse").get<double>()), percent(all.at("relativeTrimmedRmse").get<double>()),
         countText(reference.at("samples").get<std::uint64_t>()),
         percent(all.at("relativeNoise").get<double>()),
         percent(all.at("relativeError").get<double>()) + doubt,
         hasTexels ? percent(score.at("byTier").at("texels").at("relativeError").get<double>()) : "",
         fmt::format("{:.1f}", score.at("psnrDecibel").get<double>()),
         fmt::format("{:.3f}", score.at("meanFlip").get<double>()),
         fmt::format("{:.3f}", score.at("noiseFlip").get<double>())});
}

std::string verifyTable(const ResultLines& lines) {
    std::string table = headOf({"scene, camera", "profile", "paths a texel", "bake, s", "file, MB",
                                "by texels", "RMSE / mean", "trimmed", "paths of the reference", "its noise",
                                "without it", "of texels", "PSNR, dB", "FLIP", "noise's"},
                               2);
    std::vector<std::string> profiles;  // in the order of their first line
    for (const Json& line : lines)
        if (std::ranges::find(profiles, line.at("profile").get<std::string>()) == profiles.end())
            profiles.push_back(line.at("profile"));
    for (const std::string& profile : profiles)
        for (const Json& line : lines)
            if (line.at("profile") == profile) table += verifyRow(line);
    return table;
}

// ---- Light on faces: bench_faces ----

std::string faceSpeedTable(const ResultLines& lines) {
    std::string table =
        headOf({"scene", "rays a value, at most", "faces", "divided", "values", "sweeps", "billion rays",
                "billion rays/s", "noise", "at the largest number", "bake, s"},
               1);
    for (const Json& line : lines) {
        if (!line.contains("seconds")) continue;
        const double rays = line.at("light").at("rays").get<double>();
        table += rowOf({line.at("scene").get<std::string>(), line.at("what").get<std::string>(),
                        countText(line.at("faces").get<std::uint64_t>()),
                        countText(line.at("divided").get<std::uint64_t>()),
                        countText(line.at("values").get<std::uint64_t>()),
                        std::to_string(line.at("sweeps").get<int>()), fmt::format("{:.2f}", 1e-9 * rays),
                        fmt::format("{:.2f}", 1e-6 * rays / line.at("light").at("gpuMs").get<double>()),
                        fmt::format("{:.2f} %", 100.0 * line.at("noise").get<double>()),
                        percent(line.at("noisyFraction").get<double>()),
                        fmt::format("{:.2f}", line.at("seconds").get<double>())});
    }
    return table;
}

std::string faceQualityTable(const ResultLines& lines) {
    std::string table = headOf({"scene, camera", "light", "without its noise", "trimmed", "brighter",
                                "reference's noise", "paths", "FLIP", "noise's"},
                               2);
    for (const Json& line : lines) {
        if (!line.contains("camera")) continue;
        table += rowOf(
            {fmt::format("{}, {}", line.at("scene").get<std::string>(), line.at("camera").get<std::string>()),
             line.at("what").get<std::string>(), percent(line.at("error").get<double>()),
             percent(line.at("trimmed").get<double>()),
             fmt::format("{:+.1f} %", 100.0 * line.at("bias").get<double>()),
             percent(line.at("noise").get<double>()), countText(line.at("samples").get<std::uint64_t>()),
             fmt::format("{:.3f}", line.at("flip").get<double>()),
             fmt::format("{:.3f}", line.at("noiseFlip").get<double>())});
    }
    return table;
}

// ---- Rays: bench_trace ----

struct View {
    std::string scene;
    std::string camera;
};

class TraceLines {
  public:
    explicit TraceLines(const ResultLines& lines) : lines_(lines) {}

    /// In the order of their first line.
    std::vector<View> views() const {
        std::vector<View> views;
        for (const Json& line : lines_) {
            if (!line.contains("camera")) continue;
            const View view{line.at("scene"), line.at("camera")};
            if (std::ranges::none_of(
                    views, [&](const View& v) { return v.scene == view.scene && v.camera == view.camera; }))
                views.push_back(view);
        }
        return views;
    }

    const Json* find(const View& view, const std::string& rays, const std::string& way) const {
        for (const Json& line : lines_) {
            if (line.contains("camera") && line.at("scene") == view.scene &&
                line.at("camera") == view.camera && line.at("rays") == rays && line.at("way") == way)
                return &line;
        }
        return nullptr;
    }

    std::optional<double> billionRays(const View& view, const std::string& rays,
                                      const std::string& way) const {
        const Json* const line = find(view, rays, way);
        return line == nullptr ? std::nullopt : std::optional(1e-3 * line->at("Mrays/s").get<double>());
    }

    std::optional<double> overPlain(const View& view, const std::string& rays, const std::string& way) const {
        const auto ours = billionRays(view, rays, way);
        const auto plain = billionRays(view, rays, "plain");
        return ours && plain ? std::optional(*ours / *plain) : std::nullopt;
    }

  private:
    const ResultLines& lines_;
};

std::string twoDigits(const std::optional<double>& value) {
    return value ? fmt::format("{:.2f}", *value) : "-";
}

std::string traceTable(const std::string& rays, const ResultLines& lines) {
    const TraceLines traced(lines);
    std::vector<std::pair<std::string, std::string>> ways{{"geometry", "geometry"}};
    const bool persistent = rays == "diffuse";
    if (persistent) ways.emplace_back("geometry-persistent", "persistent");
    ways.emplace_back("scene", "everything");
    if (persistent) ways.emplace_back("scene-persistent", "persistent");
    ways.emplace_back("plain", "plain octree loop");
    ways.emplace_back("nanovdb", "NanoVDB HDDA");
    Cells titles{"view"};
    for (const auto& way : ways) titles.push_back(way.second);
    const std::string compared = persistent ? "geometry-persistent" : "geometry";
    titles.insert(titles.end(), {persistent ? "geometry, persistent / plain" : "geometry / plain", "steps"});
    std::string table = headOf(titles, 1);
    for (const View& view : traced.views()) {
        Cells cells{view.scene + " " + view.camera};
        for (const auto& way : ways) cells.push_back(twoDigits(traced.billionRays(view, rays, way.first)));
        cells.push_back(twoDigits(traced.overPlain(view, rays, compared)));
        const Json* const geometry = traced.find(view, rays, "geometry");
        const Json* const counted = geometry != nullptr ? geometry : traced.find(view, rays, "scene");
        cells.push_back(counted == nullptr ? "-"
                                           : fmt::format("{:.1f}", counted->at("stepsPerRay").get<double>()));
        table += rowOf(cells);
    }
    return table;
}

std::string modelTable(const ResultLines& lines) {
    std::string table = headOf({"scene", "voxels (models)", "instances", "bytes on the device", "B/voxel",
                                "descriptors, lookup and values instead", "load to device, ms"},
                               1);
    for (const Json& line : lines) {
        if (line.contains("camera")) continue;
        const auto count = [&](const char* key) { return countText(line.at(key).get<std::uint64_t>()); };
        const double perVoxel = line.at("bytes").get<double>() / line.at("voxels").get<double>();
        table += rowOf({line.at("scene").get<std::string>(), count("voxels"), count("instances"),
                        count("bytes"), fmt::format("{:.3f}", perVoxel), count("octreeBytes"),
                        fmt::format("{:.0f}", line.at("buildMs").get<double>())});
    }
    return table;
}

std::string bouncesTable(const ResultLines& lines) {
    const TraceLines traced(lines);
    std::string table = headOf({"view", "three bounces, everything"}, 1);
    for (const View& view : traced.views()) {
        if (const auto rate = traced.billionRays(view, "diffuse-3", "scene"))
            table += rowOf({view.scene + " " + view.camera, twoDigits(rate)});
    }
    return table;
}

/// Over the views that the plain loop has been through.
std::string meansTable(const ResultLines& lines) {
    struct Kind {
        const char* rays;
        const char* way;
        const char* title;
    };
    constexpr std::array<Kind, 4> kKinds{{{"primary", "geometry", "primary"},
                                          {"shadow", "geometry", "shadow"},
                                          {"diffuse", "geometry", "diffuse, one ray an invocation"},
                                          {"diffuse", "geometry-persistent", "diffuse, persistent"}}};
    const TraceLines traced(lines);
    std::string table = headOf({"geometry / plain", "geometric mean", "least", "views"}, 1);
    for (const Kind& kind : kKinds) {
        double logs = 0.0;
        double least = std::numeric_limits<double>::infinity();
        int views = 0;
        for (const View& view : traced.views()) {
            const auto ratio = traced.overPlain(view, kind.rays, kind.way);
            if (!ratio) continue;
            logs += std::log(*ratio);
            least = std::min(least, *ratio);
            ++views;
        }
        if (views != 0)
            table += rowOf(
                {kind.title, twoDigits(std::exp(logs / views)), twoDigits(least), std::to_string(views)});
    }
    return table;
}

std::optional<ResultLines> readLines(const std::filesystem::path& file) {
    std::ifstream in(file);
    if (!in) return std::nullopt;
    ResultLines lines;
    for (std::string line; std::getline(in, line);) {
        if (line.empty()) continue;
        Json json = Json::parse(line, nullptr, false);
        if (json.is_discarded())
            throw std::runtime_error(file.string() + ": a line is not JSON: " + line.substr(0, 80));
        lines.push_back(std::move(json));
    }
    return lines;
}

}  // namespace

std::string tableOf(const std::string& name, const ResultLines& lines) {
    try {
        if (name == "verify") return verifyTable(lines);
        if (name == "faces-speed") return faceSpeedTable(lines);
        if (name == "faces-quality") return faceQualityTable(lines);
        if (name == "trace-models") return modelTable(lines);
        if (name == "trace-bounces") return bouncesTable(lines);
        if (name == "trace-means") return meansTable(lines);
        for (const char* const rays : {"primary", "shadow", "diffuse"})
            if (name == std::string("trace-") + rays) return traceTable(rays, lines);
    } catch (const nlohmann::json::exception& error) {
        throw std::runtime_error("table " + name + ": " + error.what());
    }
    throw std::runtime_error("there is no table named " + name);
}

TabledDocument withTables(const std::string& document, const std::filesystem::path& results) {
    TabledDocument made;
    std::size_t done = 0;
    for (std::size_t begin = document.find(kBegin); begin != std::string::npos;
         begin = document.find(kBegin, done)) {
        const std::size_t headEnd = document.find('\n', begin + 1);
        const std::size_t end = document.find(kEnd, begin);
        const std::string head = document.substr(begin + 1, headEnd - begin - 1);
        if (end == std::string::npos || headEnd == std::string::npos || !head.ends_with(kBeginEnds))
            throw std::runtime_error("a table without its end: " + head);
        std::istringstream words(head.substr(0, head.size() - std::string(kBeginEnds).size()));
        std::string comment, table, name, of;
        words >> comment >> table >> name >> of;
        ResultLines lines;
        bool isWhole = true;
        for (std::string file; words >> file;) {
            const auto more = readLines(results / file);
            if (more)
                lines.insert(lines.end(), more->begin(), more->end());
            else
                made.absent.push_back(file);
            isWhole = isWhole && more.has_value();
        }
        made.text += document.substr(done, headEnd + 1 - done);
        made.text += isWhole ? tableOf(name, lines) : document.substr(headEnd + 1, end - headEnd - 1);
        made.tables += isWhole ? 1u : 0u;
        done = end;
    }
    made.text += document.substr(done);
    return made;
}

}  // namespace pfvox::bench
