// Small probe fields with something of every kind in them; nothing in them depends on floating point of a
// library.
#pragma once

#include <pfvox/pf_probe.hpp>
#include <pfvox/probe_maths.hpp>

#include <algorithm>
#include <cstring>
#include <vector>

namespace pfvox::test {

/// A hash as a random number: the same everywhere.
inline std::uint32_t mix(std::uint32_t a, std::uint32_t b = 0) {
    std::uint32_t x = a * 0x9e3779b9u ^ (b + 0x7f4a7c15u) * 0x85ebca6bu;
    x = (x ^ (x >> 16)) * 0x21f0aaadu;
    x = (x ^ (x >> 15)) * 0x735a2d97u;
    return x ^ (x >> 15);
}

inline void mirrorBorder(std::vector<std::uint32_t>& words, std::uint32_t interior) {
    const std::uint32_t edge = interior + 2;
    for (std::uint32_t i = 0; i < edge * edge; ++i) {
        const glm::ivec2 source = borderSource({static_cast<int>(i % edge), static_cast<int>(i / edge)},
                                               static_cast<int>(interior));
        words[i] =
            words[static_cast<std::size_t>(source.x + 1) + edge * static_cast<std::size_t>(source.y + 1)];
    }
}

/// Words without NaN and infinity.
inline std::uint32_t lightWord(std::uint32_t seed) {
    return mix(seed) & 0x7be1efbfu & ~0x80000000u;
}

inline ProbeFieldInfo probeInfo(glm::uvec3 counts = {3, 2, 2}, ProbeResolution resolution = {32, 16, 4, 6}) {
    ProbeFieldInfo info{.grid = {.start = {-1, 0.5f, 2}, .step = {1, 2, 0.5f}, .counts = counts},
                        .range = {},
                        .resolution = resolution,
                        .depth = {.scale = 8, .farMetres = 125},
                        .lightContent = kLightOfSky | kLightOfEmitters | kLightOfBouncedSun,
                        .settings = {.seed = 77,
                                     .tracedResolution = 32,
                                     .minSamples = 32,
                                     .maxSamples = 4096,
                                     .maxBounces = 16,
                                     .noiseTarget = 0.125f,
                                     .noiseFloor = 0.25f,
                                     .sampling = 1,
                                     .stratified = true,
                                     .relocate = true,
                                     .filter = 1},
                        .sceneHash = {{1, 2, 3}},
                        .shaderHash = {{4, 5, 6}},
                        .deviceName = "test device, driver 1",
                        .toolName = "probe-bake 0.1.0"};
    info.range.end = static_cast<std::uint32_t>(info.grid.probeCount());
    return info;
}

/// Probe 3 of 5 is inactive, 4 of 5 relocated. Min maps and borders are right.
inline ProbeData probeOf(const ProbeFieldInfo& info, std::uint32_t index, std::uint32_t seed = 0) {
    ProbeData data;
    data.inputHash.bytes = {9, static_cast<std::uint8_t>(index), static_cast<std::uint8_t>(index >> 8),
                            static_cast<std::uint8_t>(seed)};
    if (index % 5 == 3) {
        data.record.state = ProbeState::Inactive;
        return data;
    }
    if (index % 5 == 4) {
        data.record.state = ProbeState::Relocated;
        data.record.offset = {0.25f, -0.125f, 0};
    }
    data.record.error = 0.0625f;
    data.record.noisyTileFraction = 0.5f;
    const ProbeResolution& r = info.resolution;
    const std::uint32_t key = mix(index, seed);
    data.depthNormal.resize(std::size_t{r.depth} * r.depth);
    for (std::uint32_t i = 0; i < data.depthNormal.size(); ++i) {
        const std::uint32_t noise = mix(key, i);
        const std::uint32_t code = noise % 50 == 0 ? 65535 : 20000 + i % 256 + (noise >> 28);
        data.depthNormal[i] = code | (i / 256 % 4) << 17 | 0x7f000000u;
    }
    const std::uint32_t minEdge = r.edgeOf(ProbeLayer::MinDepth);
    data.minDepth.assign(std::size_t{minEdge} * minEdge, 65535);
    for (std::uint32_t i = 0; i < data.depthNormal.size(); ++i) {
        std::uint16_t& smallest = data.minDepth[i % r.depth / 16 + minEdge * (i / r.depth / 16)];
        smallest = std::min(smallest, static_cast<std::uint16_t>(data.depthNormal[i]));
    }
    for (std::uint32_t i = 0; i < r.light * r.light; ++i) data.light.push_back(lightWord(key + i / 8));
    for (std::uint64_t i = r.bytesOf(ProbeLayer::Irradiance) / 4; i > 0; --i)
        data.irradiance.push_back(lightWord(key + static_cast<std::uint32_t>(i)));
    for (std::uint64_t i = r.bytesOf(ProbeLayer::Moments) / 4; i > 0; --i)
        data.moments.push_back(mix(key, static_cast<std::uint32_t>(i)) & 0x3bff3bffu);
    if (r.irradiance != 0) mirrorBorder(data.irradiance, r.irradiance);
    if (r.moments != 0) mirrorBorder(data.moments, r.moments);
    return data;
}

inline ProximityGrid proximityOf(const ProbeFieldInfo& info, glm::uvec3 counts = {3, 2, 4}) {
    ProximityGrid grid{
        .start = {-1.5f, 0, 1.75f}, .step = {0.5f, 0.5f, 0.25f}, .counts = counts, .probes = {}};
    const auto count = static_cast<std::uint32_t>(info.grid.probeCount());
    for (std::uint32_t cell = 0; cell < grid.cellCount(); ++cell) {
        std::vector<std::uint32_t> list;
        for (std::uint32_t k = 0; k < cell % 5; ++k) {
            const std::uint32_t index = mix(cell, k) % count;
            if (index % 5 != 3 && std::ranges::find(list, index) == list.end()) list.push_back(index);
        }
        list.resize(kProbesPerCell, kNoProbe);
        grid.probes.insert(grid.probes.end(), list.begin(), list.end());
    }
    return grid;
}

inline ProbeField probeField(const ProbeFieldInfo& info, bool withProximity = true) {
    ProbeField field{.info = info, .probes = {}, .proximity = {}};
    for (std::uint32_t i = info.range.first; i < info.range.end; ++i) {
        field.probes.push_back(probeOf(info, i));
        field.probes.back().record.hash = hashOf(field.probes.back());
    }
    if (withProximity) field.proximity = proximityOf(info);
    return field;
}

}  // namespace pfvox::test
