// Light on few faces with something of every kind in it; nothing in it depends on floating point of a
// library.
#pragma once

#include <pfvox/face_light.hpp>

#include "support/probe_fields.hpp"

namespace pfvox::test {

/// Four instances of three models, one without regions; three chunks of 35, 17 and 25 faces.
inline FaceLightInfo faceInfo(FaceCodec codec = FaceCodec::Quantized) {
    const FaceInstance twice{.index = {{1}}, .faceCounts = {10, 0, 25}};
    FaceLightInfo info{
        .settings = {.seed = 0x123456789abcdefu,
                     .baseRays = 256,
                     .sweeps = 12,
                     .minRays = 1024,
                     .maxRays = 16384,
                     .noiseTarget = 0.0078125f,
                     .maxBounces = 16,
                     .sampling = 1,
                     .divide = true,
                     .codec = codec},
        .instances = {twice, {.index = {{2}}, .faceCounts = {}}, {.index = {{3}}, .faceCounts = {7}}, twice},
        .facesPerChunk = 16,
        .range = {},
        .chunks = {}};
    info.range.end = static_cast<std::uint32_t>(faceChunkPlaces(info).size());
    return info;
}

inline FaceChunkRecord faceRecordOf(std::uint32_t chunk, std::uint32_t seed = 0) {
    FaceChunkRecord record{.noise = 0.00390625f * static_cast<float>(chunk + 1), .cappedFraction = 0.25f};
    if (chunk % 2 == 1) record.noise.reset();
    record.inputHash.bytes = {7, static_cast<std::uint8_t>(chunk), static_cast<std::uint8_t>(seed)};
    return record;
}

/// All levels, faces without values, black, saturated colors, runs of similar values. What is quantized has
/// the values that a reader will have.
inline FaceChunk faceChunkOf(const FaceLightInfo& info, std::uint32_t chunk, std::uint32_t seed = 0) {
    FaceChunk light;
    const std::uint32_t key = mix(chunk, seed);
    for (std::uint32_t i = 0; i < faceChunkPlaces(info)[chunk].faceCount; ++i) {
        const std::uint32_t kind = mix(key, i) % 16;
        light.levels.push_back(kind < 4    ? static_cast<std::uint8_t>(kind)
                               : kind == 4 ? kNoFaceValue
                                           : std::uint8_t{0});
        for (std::uint32_t part = 0; part < faceValuesOf(light.levels.back()); ++part) {
            const std::uint32_t noise = mix(key + i, part);
            std::uint32_t word = (10 + i / 8) << 27 | (300 + (noise & 7)) | (250 + (noise >> 4 & 7)) << 9 |
                                 (200 + (noise >> 8 & 3)) << 18;
            if (noise % 23 == 0) word = 0;
            if (noise % 23 == 1) word &= ~(511u << 9);
            if (noise % 23 == 2) word = noise % (31u << 27);
            light.values.push_back(storedFaceValue(info.settings.codec, word));
        }
    }
    return light;
}

/// As it is read, but for storedBytes.
inline FaceLight faceLight(FaceLightInfo info = faceInfo()) {
    FaceLight light{.info = std::move(info), .chunks = {}};
    light.info.chunks.clear();
    for (std::uint32_t i = light.info.range.first; i < light.info.range.end; ++i) {
        light.chunks.push_back(faceChunkOf(light.info, i));
        light.info.chunks.push_back(faceRecordOf(i));
        light.info.chunks.back().valueCount = light.chunks.back().values.size();
        light.info.chunks.back().hash = hashOf(light.chunks.back());
    }
    return light;
}

/// A field without probes.
inline ProbeFieldInfo noProbesInfo() {
    ProbeFieldInfo info = probeInfo({0, 0, 0}, {});
    info.settings = {};
    return info;
}

}  // namespace pfvox::test
