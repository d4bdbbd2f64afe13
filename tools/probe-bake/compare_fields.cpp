#include "probe-bake/compare_fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <pfvox/probe_maths.hpp>

namespace pfvox::tools {

namespace {

/// Sums over the words of one layer.
struct LayerSums {
    LayerDifference difference;
    std::uint64_t withinOne = 0;
    double squares = 0.0;
    double peak = 0.0;
    double secondPeak = 0.0;

    void note(double apart, std::uint32_t probe) {
        if (apart <= difference.largest) return;
        difference.largest = apart;
        difference.largestProbe = probe;
    }
};

double degreesBetween(glm::vec3 a, glm::vec3 b) {
    return std::acos(std::clamp(glm::dot(glm::dvec3{a}, glm::dvec3{b}), -1.0, 1.0)) * 180.0 /
           3.14159265358979;
}

void addDepthCodes(LayerSums& sums, std::uint32_t probe, std::uint32_t a, std::uint32_t b) {
    const double apart = std::abs(static_cast<double>(a) - static_cast<double>(b));
    sums.note(apart, probe);
    sums.withinOne += apart <= 1.0 ? 1u : 0u;
}

void addDepthNormal(LayerSums& sums, std::uint32_t probe, std::uint32_t a, std::uint32_t b) {
    addDepthCodes(sums, probe, depthCodeOf(a), depthCodeOf(b));
    if (a >> 16 == b >> 16 || depthCodeOf(a) == kDepthMissCode || depthCodeOf(b) == kDepthMissCode) return;
    double& largest = sums.difference.largestNormalDegrees;
    largest = std::max(largest, degreesBetween(normalOf(a), normalOf(b)));
}

void addLight(LayerSums& sums, std::uint32_t probe, std::uint32_t a, std::uint32_t b) {
    const glm::dvec3 first{unpackLight(a)};
    const glm::dvec3 apart = glm::abs(first - glm::dvec3{unpackLight(b)});
    sums.note(std::max({apart.x, apart.y, apart.z}), probe);
    sums.squares += glm::dot(apart, apart) / 3.0;
    sums.peak = std::max({sums.peak, first.x, first.y, first.z});
    const glm::dvec3 second{unpackLight(b)};
    sums.secondPeak = std::max({sums.secondPeak, second.x, second.y, second.z});
}

void addMoments(LayerSums& sums, std::uint32_t probe, std::uint32_t a, std::uint32_t b) {
    const glm::vec2 apart = glm::abs(unpackMoments(a) - unpackMoments(b));
    sums.note(static_cast<double>(std::max(apart.x, apart.y)), probe);
}

template <class Word, class Add>
void addWords(LayerSums& sums, std::uint32_t probe, const std::vector<Word>& a, const std::vector<Word>& b,
              Add add) {
    for (std::size_t i = 0; i < a.size(); ++i) {
        add(sums, probe, std::uint32_t{a[i]}, std::uint32_t{b[i]});
        sums.difference.differentWords += a[i] != b[i] ? 1u : 0u;
    }
    sums.difference.words += a.size();
}

using AllSums = std::array<LayerSums, kProbeLayerCount>;

LayerSums& at(AllSums& sums, ProbeLayer layer) {
    return sums[static_cast<std::size_t>(layer)];
}

void addProbe(AllSums& sums, std::uint32_t probe, const ProbeData& a, const ProbeData& b) {
    addWords(at(sums, ProbeLayer::DepthNormal), probe, a.depthNormal, b.depthNormal, addDepthNormal);
    addWords(at(sums, ProbeLayer::Light), probe, a.light, b.light, addLight);
    addWords(at(sums, ProbeLayer::MinDepth), probe, a.minDepth, b.minDepth, addDepthCodes);
    addWords(at(sums, ProbeLayer::Irradiance), probe, a.irradiance, b.irradiance, addLight);
    addWords(at(sums, ProbeLayer::Moments), probe, a.moments, b.moments, addMoments);
}

std::vector<LayerDifference> finished(const AllSums& sums, const ProbeResolution& resolution) {
    std::vector<LayerDifference> layers;
    for (std::size_t i = 0; i < kProbeLayerCount; ++i) {
        LayerDifference layer = sums[i].difference;
        layer.layer = static_cast<ProbeLayer>(i);
        if (!resolution.has(layer.layer)) continue;
        const auto words = static_cast<double>(layer.words);
        const bool depth = layer.layer == ProbeLayer::DepthNormal || layer.layer == ProbeLayer::MinDepth;
        if (depth && layer.words != 0)
            layer.withinOneFraction = static_cast<double>(sums[i].withinOne) / words;
        const double peak = sums[i].peak > 0.0 ? sums[i].peak : sums[i].secondPeak;
        if (sums[i].squares > 0.0)
            layer.psnrDecibel = 10.0 * std::log10(peak * peak / (sums[i].squares / words));
        layers.push_back(layer);
    }
    return layers;
}

Result<void> checkComparable(const ProbeFieldInfo& a, const ProbeFieldInfo& b) {
    std::string what;
    const auto add = [&](bool differ, const char* name) {
        if (differ) what += (what.empty() ? "" : ", ") + std::string(name);
    };
    add(a.grid != b.grid, "grid");
    add(a.range != b.range, "range of probes");
    add(a.resolution != b.resolution, "resolution");
    add(a.depth != b.depth, "depth encoding");
    if (what.empty()) return {};
    return fail(ErrorCode::BadStructure, "cannot be compared with the first file: they differ in " + what);
}

std::vector<std::string> settingsApart(const ProbeFieldInfo& a, const ProbeFieldInfo& b) {
    std::vector<std::string> names;
    const auto add = [&](bool differ, std::string text) {
        if (differ) names.push_back(std::move(text));
    };
    for (const ProbeSettingDifference& difference : differencesOf(a.settings, b.settings))
        names.push_back(difference.first + " and " + difference.second);
    add(a.lightContent != b.lightContent, "other kinds of light");
    add(a.sceneHash != b.sceneHash, "another scene");
    add(a.shaderHash != b.shaderHash, "other programs");
    add(a.deviceName != b.deviceName, fmt::format("the devices {} and {}", a.deviceName, b.deviceName));
    add(a.toolName != b.toolName, fmt::format("the tools {} and {}", a.toolName, b.toolName));
    return names;
}

}  // namespace

Result<FieldDifference> compareFields(const ProbeFileReader& first, const ProbeFileReader& second) {
    PFVOX_CHECK(checkComparable(first.info(), second.info()));
    const ProbeRange range = first.info().range;
    FieldDifference result{.probes = range.size(),
                           .differentRecords = {},
                           .differentSettings = settingsApart(first.info(), second.info()),
                           .layers = {}};
    AllSums sums;
    for (std::uint32_t probe = range.first; probe < range.end; ++probe) {
        const ProbeRecord& a = first.record(probe);
        const ProbeRecord& b = second.record(probe);
        result.equalProbes += a.hash == b.hash ? 1 : 0;
        if (a.state != b.state || a.offset != b.offset) result.differentRecords.push_back(probe);
        if (!a.isActive() || !b.isActive()) continue;
        // Read even where hashes are equal: the peak of the light must not depend on what differs.
        PFVOX_TRY(const ProbeData, dataA, first.readProbe(probe));
        PFVOX_TRY(const ProbeData, dataB, second.readProbe(probe));
        addProbe(sums, probe, dataA, dataB);
    }
    result.layers = finished(sums, first.info().resolution);
    return result;
}

}  // namespace pfvox::tools
