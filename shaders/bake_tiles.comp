// The noise of each tile of light maps, from the spread of its texels' batches; before the first batch, how many
// texels see a surface, and all sums become 0. A workgroup a tile.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

#include "bake_wave.glsl"

// Before the first batch.
layout(constant_id = 1) const uint kReset = 0u;

shared vec2 sums[kBakeGroupSize];
shared uint surfaces[kBakeGroupSize];

// In a fixed order: equal bits for equal texels.
void addUp() {
    uint lane = gl_LocalInvocationIndex;
    for (uint half_ = kBakeGroupSize / 2u; half_ != 0u; half_ /= 2u) {
        barrier();
        if (lane < half_) {
            sums[lane] += sums[lane + half_];
            surfaces[lane] += surfaces[lane + half_];
        }
    }
    barrier();
}

void main() {
    if (groupIndex() >= push.count) return;
    BakeWave wave = Waves(push.wave).at[0];
    uint tile = push.first + groupIndex();
    uint lane = gl_LocalInvocationIndex;
    uvec2 texel = texelOfTile(wave, tile, lane);
    uint probe = probeOfTile(wave, tile);
    uint index = sumIndex(wave, probe, texel);
    TileStatistics statistics = Tiles(wave.tiles).at[tile];
    bool sees = surfacesUnder(wave, probe, texel) != 0u;
    if (kReset != 0u) {
        Vectors(wave.sums).at[index] = vec4(0.0);
        statistics.batches = 0u;
    }
    vec4 sum = Vectors(wave.sums).at[index];
    float batches = float(statistics.batches);
    sums[lane] = vec2(0.0);
    if (sees && statistics.batches > 1u)
        sums[lane] = vec2(meanOf(sum.rgb) / (batches * float(kBatchSamples)), sum.w / (batches * (batches - 1.0)));
    surfaces[lane] = sees ? 1u : 0u;
    addUp();
    if (lane == 0u) Tiles(wave.tiles).at[tile] = TileStatistics(sums[0].x, sums[0].y, surfaces[0], statistics.batches);
}
