// What the programs of a wave have in common: where things lie, and queues. Includes bake_rays.glsl.
#ifndef PFVOX_BAKE_WAVE_GLSL
#define PFVOX_BAKE_WAVE_GLSL

#include "shared/bake.glsl.h"
#include "shared/probe_maths.glsl.h"
#define PFVOX_TRACE_GROUP_SIZE kBakeGroupSize
#include "bake_rays.glsl"

layout(local_size_x = kBakeGroupSize) in;

layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer Waves { BakeWave at[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer Probes { BakeProbe at[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) buffer SeenTexels { SeenTexel at[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) buffer Vectors { vec4 at[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) buffer Tiles { TileStatistics at[]; };
layout(buffer_reference, std430, buffer_reference_align = 8) readonly buffer Items { uvec2 at[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer Runs { GatherRun at[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) buffer Paths { PathState at[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) buffer PathHits { PathHit at[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) buffer ShadowRays { ShadowRay at[]; };
layout(buffer_reference, std430, buffer_reference_align = 4) buffer Numbers { uint at[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) buffer Controls { WaveControl control; };
layout(push_constant) uniform Push { WavePush push; };

// Of all workgroups of the launch, however many rows it has.
uint groupIndex() { return gl_WorkGroupID.y * kBakeRowGroups + gl_WorkGroupID.x; }
uint invocationIndex() { return groupIndex() * kBakeGroupSize + gl_LocalInvocationIndex; }

// --- Tiles ---

uint tilesOf(BakeWave wave) { return wave.lightResolution * wave.lightResolution / kTileTexels; }

// Texel of the light map that is number `lane` of a tile of the group.
uvec2 texelOfTile(BakeWave wave, uint tile, uint lane) {
    uint within = tile % tilesOf(wave);
    uint tilesPerRow = wave.lightResolution / kTileEdge;
    return uvec2(within % tilesPerRow, within / tilesPerRow) * kTileEdge + uvec2(lane % kTileEdge, lane / kTileEdge);
}

uint probeOfTile(BakeWave wave, uint tile) { return tile / tilesOf(wave); }

// In the sums.
uint sumIndex(BakeWave wave, uint probe, uvec2 texel) {
    return (probe * wave.lightResolution + texel.y) * wave.lightResolution + texel.x;
}

// In the texels that the probes see.
uint seenIndex(BakeWave wave, uint probe, uvec2 texel) {
    return (probe * wave.depthResolution + texel.y) * wave.depthResolution + texel.x;
}

// The texels of the depth map under one of the light map that see a surface: bit i + 4j.
uint surfacesUnder(BakeWave wave, uint probe, uvec2 texel) {
    uint block = wave.depthResolution / wave.lightResolution;
    uint mask = 0u;
    for (uint j = 0u; j < block; ++j) {
        for (uint i = 0u; i < block; ++i) {
            uint index = seenIndex(wave, probe, texel * block + uvec2(i, j));
            if (SeenTexels(wave.texels).at[index].metres >= 0.0) mask |= 1u << (i + 4u * j);
        }
    }
    return mask;
}

void countCapped(BakeWave wave, TraceStatistics statistics) {
    if (statistics.stepLimitReached != 0u) atomicAdd(Controls(wave.control).control.stepLimitRays, 1u);
}

#endif
