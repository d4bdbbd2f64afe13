// The light that the paths of a wave have brought, added to the sums of their texels: the sixteen samples of a batch in
// their order, then batch after batch. A workgroup a run of batches of one tile, an invocation a texel.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

#include "bake_wave.glsl"

void main() {
    if (groupIndex() >= push.count) return;
    BakeWave wave = Waves(push.wave).at[0];
    GatherRun run = Runs(wave.runs).at[groupIndex()];
    uint lane = gl_LocalInvocationIndex;
    uint index = sumIndex(wave, probeOfTile(wave, run.tile), texelOfTile(wave, run.tile, lane));
    vec4 sum = Vectors(wave.sums).at[index];
    float batches = float(Items(wave.items).at[run.firstItem].y);  // before this one
    for (uint item = run.firstItem; item < run.firstItem + run.itemCount; ++item) {
        vec3 batch = vec3(0.0);
        for (uint i = 0u; i < kBatchSamples; ++i)
            batch += Vectors(wave.arrived).at[item * kItemPaths + i * kTileTexels + lane].rgb;
        // Welford 1962, "Note on a Method for Calculating Corrected Sums of Squares and Products".
        float value = meanOf(batch) / float(kBatchSamples);
        float before = batches > 0.0 ? meanOf(sum.rgb) / (batches * float(kBatchSamples)) : value;
        sum.rgb += batch;
        batches += 1.0;
        float after = meanOf(sum.rgb) / (batches * float(kBatchSamples));
        sum.w += max((value - before) * (value - after), 0.0);
    }
    Vectors(wave.sums).at[index] = sum;
    if (lane == 0u) Tiles(wave.tiles).at[run.tile].batches = uint(batches);
}
