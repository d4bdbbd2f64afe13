#include "probe-bake/probe_statistics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <pfvox/probe_maths.hpp>

#include "common/text.hpp"

namespace pfvox::tools {

namespace {

void addDepth(const ProbeFieldInfo& info, const ProbeData& data, ProbeStatistics& statistics) {
    const std::uint32_t resolution = info.resolution.depth;
    const DepthCoder coder(info.depth);
    double all = 0.0;
    double hit = 0.0;
    double depthSum = 0.0;
    std::uint32_t nearest = kDepthMissCode;
    for (std::uint32_t y = 0; y < resolution; ++y) {
        for (std::uint32_t x = 0; x < resolution; ++x) {
            const double weight = texelSolidAngle(x, y, resolution);
            all += weight;
            const std::uint32_t code = depthCodeOf(data.depthNormal[x + resolution * y]);
            if (code == kDepthMissCode) continue;
            hit += weight;
            depthSum += weight * coder.decode(code);
            nearest = std::min(nearest, code);
        }
    }
    statistics.missFraction = hit > 0.0 ? (all - hit) / all : 1.0;
    if (hit == 0.0) return;
    statistics.minDepthMetres = coder.decode(nearest);
    statistics.meanDepthMetres = depthSum / hit;
}

/// Solid angle of the part of a light texel that meets a surface: light maps may be coarser than depth maps.
double hitWeight(const ProbeFieldInfo& info, const ProbeData& data, std::uint32_t x, std::uint32_t y) {
    const std::uint32_t resolution = info.resolution.depth;
    if (resolution == 0) return texelSolidAngle(x, y, info.resolution.light);
    const std::uint32_t block = std::max(resolution / info.resolution.light, 1u);
    double weight = 0.0;
    for (std::uint32_t j = y * block; j < std::min((y + 1) * block, resolution); ++j) {
        for (std::uint32_t i = x * block; i < std::min((x + 1) * block, resolution); ++i) {
            if (depthCodeOf(data.depthNormal[i + resolution * j]) != kDepthMissCode)
                weight += texelSolidAngle(i, j, resolution);
        }
    }
    return weight;
}

void addLight(const ProbeFieldInfo& info, const ProbeData& data, ProbeStatistics& statistics) {
    const std::uint32_t resolution = info.resolution.light;
    glm::dvec3 sum(0.0);
    double weights = 0.0;
    double largest = 0.0;
    for (std::uint32_t y = 0; y < resolution; ++y) {
        for (std::uint32_t x = 0; x < resolution; ++x) {
            const double weight = hitWeight(info, data, x, y);
            if (weight == 0.0) continue;
            const glm::dvec3 light{unpackLight(data.light[x + resolution * y])};
            sum += weight * light;
            weights += weight;
            largest = std::max({largest, light.x, light.y, light.z});
        }
    }
    if (weights == 0.0) return;
    statistics.meanIndirect = sum / weights;
    statistics.maxIndirect = largest;
}

}  // namespace

ProbeStatistics statisticsOf(const ProbeFieldInfo& info, const ProbeData& data) {
    ProbeStatistics statistics;
    if (!data.record.isActive()) return statistics;
    if (info.resolution.depth != 0) addDepth(info, data, statistics);
    if (info.resolution.light != 0) addLight(info, data, statistics);
    return statistics;
}

std::string countsText(const ProbeCounts& counts) {
    return fmt::format("{} active, {} of them relocated; {} inactive", formatCount(counts.active),
                       formatCount(counts.relocated), formatCount(counts.inactive));
}

Json countsJson(const ProbeCounts& counts) {
    return {{"active", counts.active}, {"relocated", counts.relocated}, {"inactive", counts.inactive}};
}

std::string percentText(const std::optional<double>& fraction) {
    return fraction ? fmt::format("{:.2f} %", 100.0 * *fraction) : "unknown";
}

Json orNull(const std::optional<double>& value) {
    return value ? Json(*value) : Json(nullptr);
}

}  // namespace pfvox::tools
