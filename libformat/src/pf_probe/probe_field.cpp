// The value types: sizes, names, hashes, and whether they can be written.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <pfvox/pf_probe.hpp>

#include "io/hash.hpp"
#include "pf_probe/frame_codec.hpp"
#include "pf_probe/records.hpp"
#include "shared/probe_maths.glsl.h"

namespace pfvox {

namespace {

constexpr float kDepthScaleTimesFar = 1000.0f;

bool isFinite(glm::vec3 v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

bool isPositive(glm::vec3 v) {
    return isFinite(v) && v.x > 0 && v.y > 0 && v.z > 0;
}

Result<void> checkLightWords(std::span<const std::uint32_t> words, ProbeLayer layer) {
    const auto broken =
        std::ranges::find_if(words, [](std::uint32_t w) { return !shared::isFiniteLight(w); });
    if (broken == words.end()) return {};
    return fail(ErrorCode::BadValue,
                fmt::format("{}: texel {} is no finite number", toString(layer), broken - words.begin()));
}

}  // namespace

std::string_view toString(ProbeLayer layer) {
    constexpr std::array<std::string_view, kProbeLayerCount> kNames{"depth-normal", "light", "min-depth",
                                                                    "irradiance", "moments"};
    return kNames[static_cast<std::size_t>(layer)];
}

std::string_view toString(ProbeProfile profile) {
    constexpr std::array<std::string_view, 4> kNames{"custom", "thesis", "probes", "compact"};
    return kNames[static_cast<std::size_t>(profile)];
}

std::string_view toString(ProbeState state) {
    constexpr std::array<std::string_view, 3> kNames{"active", "inactive", "relocated"};
    return kNames[static_cast<std::size_t>(state)];
}

std::uint32_t ProbeResolution::edgeOf(ProbeLayer layer) const {
    switch (layer) {
        case ProbeLayer::DepthNormal:
            return depth;
        case ProbeLayer::Light:
            return light;
        case ProbeLayer::MinDepth:
            return depth / shared::kMinDepthBlock;
        case ProbeLayer::Irradiance:
            return irradiance == 0 ? 0 : irradiance + 2;
        case ProbeLayer::Moments:
            return moments == 0 ? 0 : moments + 2;
    }
    return 0;
}

std::uint64_t ProbeResolution::bytesOf(ProbeLayer layer) const {
    const std::uint64_t edge = edgeOf(layer);
    return edge * edge * probe::wordBytesOf(layer);
}

std::uint64_t ProbeResolution::bytesPerProbe() const {
    std::uint64_t bytes = 0;
    for (const ProbeLayer layer : probe::kAllLayers) bytes += bytesOf(layer);
    return bytes;
}

ProbeResolution resolutionOf(ProbeProfile profile) {
    ProbeResolution resolution{.depth = 0, .light = 0, .irradiance = 8, .moments = 14};
    if (profile == ProbeProfile::Thesis) resolution.depth = resolution.light = 1024;
    if (profile == ProbeProfile::Default) {
        resolution.depth = 512;
        resolution.light = 256;
    }
    return resolution;
}

ProbeProfile profileOf(const ProbeResolution& resolution) {
    for (const auto profile : {ProbeProfile::Thesis, ProbeProfile::Default, ProbeProfile::Compact})
        if (resolution == resolutionOf(profile)) return profile;
    return ProbeProfile::Custom;
}

std::span<const std::byte> ProbeData::bytesOf(ProbeLayer layer) const {
    switch (layer) {
        case ProbeLayer::DepthNormal:
            return std::as_bytes(std::span(depthNormal));
        case ProbeLayer::Light:
            return std::as_bytes(std::span(light));
        case ProbeLayer::MinDepth:
            return std::as_bytes(std::span(minDepth));
        case ProbeLayer::Irradiance:
            return std::as_bytes(std::span(irradiance));
        case ProbeLayer::Moments:
            return std::as_bytes(std::span(moments));
    }
    return {};
}

std::span<std::byte> ProbeData::resizeLayer(ProbeLayer layer, std::uint64_t bytes) {
    const auto resized = [&](auto& words) {
        words.resize(bytes / sizeof words[0]);
        return std::as_writable_bytes(std::span(words));
    };
    switch (layer) {
        case ProbeLayer::DepthNormal:
            return resized(depthNormal);
        case ProbeLayer::Light:
            return resized(light);
        case ProbeLayer::MinDepth:
            return resized(minDepth);
        case ProbeLayer::Irradiance:
            return resized(irradiance);
        case ProbeLayer::Moments:
            return resized(moments);
    }
    return {};
}

DepthEncoding depthEncodingFor(glm::vec3 boxMin, glm::vec3 boxMax) {
    const float diagonal = glm::length(boxMax - boxMin);
    const float farMetres = diagonal > 0 && std::isfinite(diagonal) ? diagonal : DepthEncoding{}.farMetres;
    return {.scale = kDepthScaleTimesFar / farMetres, .farMetres = farMetres};
}

std::uint64_t hashOf(const ProbeData& data) {
    std::array<probe_layout::Frame, kProbeLayerCount> frames{};
    for (const ProbeLayer layer : probe::kAllLayers) {
        const auto bytes = data.bytesOf(layer);
        if (!bytes.empty()) frames[static_cast<std::size_t>(layer)].rawHash = io::xxh3_64(bytes);
    }
    return probe::hashOf(data.record, frames);
}

ProbeCounts countProbes(std::span<const ProbeRecord> records) {
    ProbeCounts counts;
    for (const ProbeRecord& record : records) {
        ++(record.isActive() ? counts.active : counts.inactive);
        if (record.state == ProbeState::Relocated) ++counts.relocated;
    }
    return counts;
}

Result<void> checkProbeInfo(const ProbeFieldInfo& info) {
    const auto bad = [](std::string message) { return fail(ErrorCode::BadValue, std::move(message)); };
    const ProbeGrid& grid = info.grid;
    if (!isFinite(grid.start) || !isPositive(grid.step))
        return bad("the grid needs finite positions and steps above 0");
    const bool hasProbes = grid.counts != glm::uvec3(0u);
    if (hasProbes && (grid.counts.x == 0 || grid.counts.y == 0 || grid.counts.z == 0))
        return bad("the grid has no probes along an axis");
    // Step by step: the product of three counts can pass 2^64.
    if (std::uint64_t{grid.counts.x} * grid.counts.y >= kNoProbe || grid.probeCount() >= kNoProbe)
        return bad("more probes than 32 bits can count");
    if (info.range.first > info.range.end || info.range.end > grid.probeCount()) {
        return bad(
            fmt::format("probes {}:{} of a grid of {}", info.range.first, info.range.end, grid.probeCount()));
    }
    const ProbeResolution& r = info.resolution;
    if (hasProbes && r.bytesPerProbe() == 0) return bad("a probe has no layers");
    if (std::max({r.depth, r.light, r.irradiance, r.moments}) > kMaxProbeResolution)
        return bad(fmt::format("a map has more than {} texels along an edge", kMaxProbeResolution));
    if (r.depth % shared::kMinDepthBlock != 0)
        return bad(fmt::format("depth maps of {} texels along an edge: needs a multiple of {}", r.depth,
                               shared::kMinDepthBlock));
    const auto isRange = [](float v) { return std::isfinite(v) && v > 0; };
    if (!isRange(info.depth.scale) || !isRange(info.depth.farMetres) ||
        !std::isfinite(info.depth.scale * info.depth.farMetres)) {
        return bad("the depth encoding needs a finite scale and Far above 0");
    }
    if ((info.lightContent & ~kKnownLight) != 0)
        return bad(fmt::format("unknown kinds of light 0x{:x}", info.lightContent & ~kKnownLight));
    if (!(info.settings.noiseTarget >= 0) || !std::isfinite(info.settings.noiseTarget))
        return bad("the noise target is no number from 0 up");
    if (const auto floor = info.settings.noiseFloor; floor && !std::isfinite(*floor))
        return bad("the noise floor is not finite");
    if (info.deviceName.size() > probe::kMaxNameBytes || info.toolName.size() > probe::kMaxNameBytes)
        return bad("a name is too long");
    return {};
}

Result<void> checkProbeData(const ProbeFieldInfo& info, std::uint32_t index, const ProbeData& data) {
    const auto inProbe = [&](Result<void> result) {
        if (!result) result.error().message = fmt::format("probe {}: {}", index, result.error().message);
        return result;
    };
    if (!info.range.contains(index)) {
        return inProbe(fail(ErrorCode::BadReference,
                            fmt::format("outside the probes {}:{}", info.range.first, info.range.end)));
    }
    PFVOX_CHECK(inProbe(probe::checkRecord(data.record)));
    for (const ProbeLayer layer : probe::kAllLayers) {
        const std::uint64_t expected = data.record.isActive() ? info.resolution.bytesOf(layer) : 0;
        if (data.bytesOf(layer).size() != expected) {
            return inProbe(fail(ErrorCode::BadStructure,
                                fmt::format("{} has {} bytes and should have {}", toString(layer),
                                            data.bytesOf(layer).size(), expected)));
        }
    }
    PFVOX_CHECK(inProbe(checkLightWords(data.light, ProbeLayer::Light)));
    return inProbe(checkLightWords(data.irradiance, ProbeLayer::Irradiance));
}

Result<void> checkProximityGrid(const ProbeFieldInfo& info, const ProximityGrid& grid) {
    const auto bad = [](ErrorCode code, const std::string& message) {
        return fail(code, "proximity grid: " + message);
    };
    if (!isFinite(grid.start) || !isPositive(grid.step))
        return bad(ErrorCode::BadValue, "needs finite positions and steps above 0");
    if (std::uint64_t{grid.counts.x} * grid.counts.y > kNoProbe || grid.cellCount() > kNoProbe)
        return bad(ErrorCode::BadValue, "more cells than 32 bits can count");
    if (grid.probes.size() != grid.cellCount() * kProbesPerCell) {
        return bad(ErrorCode::BadStructure,
                   fmt::format("{} indices for {} cells", grid.probes.size(), grid.cellCount()));
    }
    for (std::size_t i = 0; i < grid.probes.size(); ++i) {
        const std::uint32_t index = grid.probes[i];
        const std::size_t first = i - i % kProbesPerCell;
        if (index == kNoProbe) continue;
        if (index >= info.grid.probeCount()) {
            return bad(ErrorCode::BadReference,
                       fmt::format("cell {} names probe {} of {}", i / kProbesPerCell, index,
                                   info.grid.probeCount()));
        }
        for (std::size_t j = first; j < i; ++j) {
            if (grid.probes[j] == index || grid.probes[j] == kNoProbe) {
                return bad(ErrorCode::BadStructure,
                           fmt::format("cell {} names a probe twice or behind a gap", i / kProbesPerCell));
            }
        }
    }
    return {};
}

}  // namespace pfvox
