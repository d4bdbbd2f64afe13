// The light of the texels of a group of probes, taken from the faces that they see. A workgroup a tile.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

#include "bake_wave.glsl"
#include "face_lookup.glsl"

void main() {
    if (groupIndex() >= push.count) return;
    BakeWave wave = Waves(push.wave).at[0];
    Scene scene = Scene(BakeScenes(wave.scene).at[0].scene);
    uint tile = push.first + groupIndex();
    uvec2 texel = texelOfTile(wave, tile, gl_LocalInvocationIndex);
    uint probe = probeOfTile(wave, tile);
    uint block = wave.depthResolution / wave.lightResolution;
    RayCounts counts = RayCounts(0u, TraceStatistics(0u, 0u));
    vec4 sum = vec4(0.0);
    for (uint i = 0u; i < block * block; ++i) {
        uvec2 at = texel * block + uvec2(i % block, i / block);
        vec3 direction = directionOfTexel(at.x, at.y, wave.depthResolution);
        Ray ray = Ray(Probes(wave.probes).at[probe].position, kInfinity, direction, 0.0);
        Hit hit = castRay(scene, ray, counts);
        if (hit.instance == kNoInstance) continue;
        FaceLight light = faceLightOf(FaceFields(push.faces).field, scene, ray, hit);
        if (light.known) sum += vec4(light.indirect, 1.0);
    }
    countCapped(wave, counts.trace);
    // As if it had been one batch of paths.
    vec3 mean = sum.rgb / max(sum.w, 1.0);
    Vectors(wave.sums).at[sumIndex(wave, probe, texel)] = vec4(mean * float(kBatchSamples), 0.0);
    if (gl_LocalInvocationIndex == 0u) Tiles(wave.tiles).at[tile].batches = 1u;
}
