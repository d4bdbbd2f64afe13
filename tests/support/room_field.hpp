// RoomField: the probes of the box room with light that is a known function of the place, uploaded to the
// test device.
#pragma once

#include <oneapi/tbb/parallel_for.h>

#include <functional>
#include <pfvox/gpu_probes.hpp>
#include <pfvox/probe_file.hpp>
#include <pfvox/probe_layers.hpp>
#include <pfvox/proximity.hpp>

#include "support/box_room.hpp"
#include "support/gpu_fixture.hpp"

namespace pfvox::test {

/// I at a surface point, by its place and normal.
using LightAt = std::function<glm::vec3(glm::vec3 position, glm::vec3 normal)>;

inline glm::vec3 smoothLight(glm::vec3 p, glm::vec3 n) {
    return 0.5f + 0.04f * glm::vec3{p.x, p.y + p.z, 10.0f - p.z} + 0.1f * n;
}

struct RoomFieldSettings {
    ProbeResolution resolution;
    glm::uvec3 counts{4, 2, 4};
    glm::uvec3 cells{0};  ///< of the proximity grid; 0 = none
    LightAt light = smoothLight;
    float albedo = 0.0f;  ///< of the surfaces; what leaves them is albedo x I
};

inline bool isFree(const BoxRoom& room, glm::vec3 p) {
    for (int side = 0; side < 6; ++side) {
        glm::vec3 apart{0.0f};
        apart[side / 2] = side % 2 == 0 ? -0.1f : 0.1f;
        if (room.isSolid(p + apart)) return false;
    }
    return !room.isSolid(p);
}

/// The free place nearest to a grid point, on a lattice of 7^3 within 0.45 step; inactive without one.
inline ProbeRecord placeProbe(const BoxRoom& room, const ProbeGrid& grid, std::uint32_t probe) {
    ProbeRecord record;
    float best = std::numeric_limits<float>::infinity();
    for (int i = 0; i < 343; ++i) {
        const glm::vec3 offset = 0.15f * grid.step * glm::vec3{i % 7 - 3, i / 7 % 7 - 3, i / 49 - 3};
        if (glm::length(offset) >= best || !isFree(room, grid.pointOf(probe) + offset)) continue;
        best = glm::length(offset);
        record.offset = offset;
    }
    record.state = best == 0.0f                                     ? ProbeState::Active
                   : best == std::numeric_limits<float>::infinity() ? ProbeState::Inactive
                                                                    : ProbeState::Relocated;
    return record;
}

inline ProbeData traceRoomProbe(const BoxRoom& room, const ProbeFieldInfo& info, std::uint32_t probe,
                                const RoomFieldSettings& settings) {
    ProbeData data;
    data.record = placeProbe(room, info.grid, probe);
    if (!data.record.isActive()) return data;
    const glm::vec3 eye = info.grid.pointOf(probe) + data.record.offset;
    const ProbeResolution& resolution = info.resolution;
    if (resolution.depth != 0) {
        data.depthNormal = traceDepthNormal(room, eye, resolution.depth, DepthCoder(info.depth));
        data.minDepth = minDepthLayer(data.depthNormal, resolution.depth);
    }
    const std::uint32_t edge = std::max(resolution.light, 64u);
    std::vector<glm::vec3> light;
    std::vector<float> distances;
    for (std::uint32_t i = 0; i < edge * edge; ++i) {
        const glm::vec3 direction = directionOfTexel(i % edge, i / edge, edge);
        const RoomHit hit = room.trace(eye, direction);
        light.push_back(settings.light(eye + hit.distance * direction, hit.normal));
        distances.push_back(hit.distance);
    }
    for (const glm::vec3& value : light)
        if (resolution.light != 0) data.light.push_back(packLight(value));
    for (glm::vec3& value : light) value *= settings.albedo;
    if (resolution.irradiance != 0)
        data.irradiance = irradianceLayer({.edge = edge, .texels = light}, resolution.irradiance);
    if (resolution.moments != 0)
        data.moments =
            momentsLayer({.edge = edge, .texels = distances}, info.grid.momentRange(), resolution.moments);
    return data;
}

/// Random points on what can be seen of the room: walls and boxes.
inline std::vector<SurfaceSample> roomSurface(const BoxRoom& room, std::size_t count, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> uniform;
    std::normal_distribution<float> normal;
    std::vector<SurfaceSample> samples;
    while (samples.size() < count) {
        const glm::vec3 from = room.size() * glm::vec3{uniform(random), uniform(random), uniform(random)};
        const glm::vec3 direction = glm::normalize(glm::vec3{normal(random), normal(random), normal(random)});
        if (room.isSolid(from)) continue;
        const RoomHit hit = room.trace(from, direction);
        samples.push_back({from + hit.distance * direction, hit.normal});
    }
    return samples;
}

inline ProbeField makeRoomField(const BoxRoom& room, const RoomFieldSettings& settings) {
    ProbeField field;
    field.info.grid = {.start = room.size() / (2.0f * glm::vec3{settings.counts}),
                       .step = room.size() / glm::vec3{settings.counts},
                       .counts = settings.counts};
    field.info.resolution = settings.resolution;
    field.info.depth = depthEncodingFor(glm::vec3{0}, room.size());
    field.info.range.end = static_cast<std::uint32_t>(field.info.grid.probeCount());
    field.info.deviceName = "test";
    field.info.toolName = "test";
    field.probes.resize(field.info.range.end);
    tbb::parallel_for(0u, field.info.range.end, [&](std::uint32_t i) {
        field.probes[i] = traceRoomProbe(room, field.info, i, settings);
    });
    return field;
}

inline void addProximity(ProbeField& field, const BoxRoom& room, const ProximityGrid& shape) {
    const CellSurfaces surfaces = sortIntoCells(roomSurface(room, 200000, 5), shape);
    std::vector<ProbeRecord> records;
    for (const ProbeData& probe : field.probes) records.push_back(probe.record);
    auto built =
        buildProximityGrid({.info = field.info,
                            .records = records,
                            .depthNormal = [&](std::uint32_t i) -> Result<std::vector<std::uint32_t>> {
                                return field.probes[i].depthNormal;
                            },
                            .shape = shape,
                            .surfaces = surfaces});
    ASSERT_TRUE(built) << describe(built.error());
    field.proximity = std::move(built->grid);
}

inline void addProximity(ProbeField& field, const BoxRoom& room, glm::uvec3 cells) {
    const glm::vec3 step = (room.size() + 1e-3f) / glm::vec3{cells};
    addProximity(field, room,
                 ProximityGrid{.start = glm::vec3{-5e-4f}, .step = step, .counts = cells, .probes = {}});
}

inline Result<gpu::GpuProbes> uploadField(gpu::Device& device, const ProbeField& field,
                                          const gpu::GpuProbeSettings& settings) {
    PFVOX_TRY(const std::vector<std::byte>, bytes, encodePfProbe(field, {}));
    DiagnosticList diagnostics;
    PFVOX_TRY(const ProbeFileReader, reader, ProbeFileReader::overBytes(bytes, Limits{}, diagnostics));
    return gpu::GpuProbes::upload(device, reader, settings);
}

}  // namespace pfvox::test
