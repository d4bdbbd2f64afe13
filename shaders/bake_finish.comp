// The maps of a group of probes as the CPU takes them, one probe after the other: words and metres of the depth map,
// then I (3 numbers) and its standard error, and the radiance that leaves the surfaces (3 numbers) of the light map. An
// invocation a texel of the light map.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

#include "bake_wave.glsl"

void storeFloats(BakeWave wave, uint at, vec3 values) {
    Numbers maps = Numbers(wave.maps);
    for (int i = 0; i < 3; ++i) maps.at[at + uint(i)] = floatBitsToUint(values[i]);
}

void main() {
    BakeWave wave = Waves(push.wave).at[0];
    uint lightTexels = wave.lightResolution * wave.lightResolution;
    uint depthTexels = wave.depthResolution * wave.depthResolution;
    uint index = push.first + invocationIndex();
    if (invocationIndex() >= push.count) return;
    uint probe = index / lightTexels;
    uint within = index % lightTexels;
    uvec2 texel = uvec2(within % wave.lightResolution, within / wave.lightResolution);
    uint tile = probe * tilesOf(wave) + texel.y / kTileEdge * (wave.lightResolution / kTileEdge) + texel.x / kTileEdge;
    float batches = float(Tiles(wave.tiles).at[tile].batches);
    vec4 sum = Vectors(wave.sums).at[index];
    bool lit = batches > 0.0 && surfacesUnder(wave, probe, texel) != 0u;
    vec3 light = lit ? sum.rgb / (batches * float(kBatchSamples)) : vec3(0.0);
    float error = lit && batches > 1.0 ? sqrt(sum.w / (batches * (batches - 1.0))) : 0.0;

    uint base = probe * (2u * depthTexels + 7u * lightTexels);
    Numbers maps = Numbers(wave.maps);
    uint block = wave.depthResolution / wave.lightResolution;
    vec3 leaving = vec3(0.0);
    for (uint j = 0u; j < block; ++j) {
        for (uint i = 0u; i < block; ++i) {
            uvec2 at = texel * block + uvec2(i, j);
            SeenTexel seen = SeenTexels(wave.texels).at[seenIndex(wave, probe, at)];
            uint to = base + at.x + wave.depthResolution * at.y;
            maps.at[to] = seen.word;
            maps.at[to + depthTexels] = floatBitsToUint(seen.metres);
            leaving += seen.direct + seen.albedo * light;
        }
    }
    uint at = base + 2u * depthTexels;
    storeFloats(wave, at + 3u * within, light);
    maps.at[at + 3u * lightTexels + within] = floatBitsToUint(error);
    storeFloats(wave, at + 4u * lightTexels + 3u * within, leaving / float(block * block));
}
