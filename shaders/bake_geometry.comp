// What the probes of a group see: distance, normal, and what leaves each texel's surface without indirect light.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

#include "bake_wave.glsl"

SeenTexel seen(BakeWave wave, BakeScene bake, vec3 probe, vec3 direction, inout RayCounts counts) {
    Scene scene = Scene(bake.scene);
    Ray ray = Ray(probe, kInfinity, direction, 0.0);
    Hit hit = castRay(scene, ray, counts);
    if (hit.instance == kNoInstance)
        return SeenTexel(vec3(0.0), -1.0, skyRadiance(bake, direction), kDepthMiss, vec3(0.0), 0u);
    // A texel stands for all that it covers: where that is more than the foot of a lamp, light right there says little of it.
    Surface surface = surfaceOf(scene, ray, hit, 0.5 * texelAngle(wave.depthResolution) * hit.t);
    MaterialRecord material = materialOf(scene, surface);
    SeenTexel texel;
    texel.lift = surface.lift;
    texel.metres = hit.t;
    texel.albedo = albedoOf(scene, surface);
    texel.normal = packWideNormal(surface.normal);
    texel.word = packDepthNormal(depthCode(hit.t, wave.depthScale, wave.depthLogRange), surface.normal);
    texel.direct = emissionOf(material);
    if (hasSun(bake, surface.normal)) {
        vec3 sun = sunAt(bake, startOf(surface), counts);
        texel.direct += texel.albedo * sun * (dot(surface.normal, -bake.sunDirection) / kPi);
    }
    return texel;
}

void main() {
    if (invocationIndex() >= push.count) return;
    BakeWave wave = Waves(push.wave).at[0];
    uint index = push.first + invocationIndex();
    uint texels = wave.depthResolution * wave.depthResolution;
    uint texel = index % texels;
    vec3 direction = directionOfTexel(texel % wave.depthResolution, texel / wave.depthResolution, wave.depthResolution);
    RayCounts counts = RayCounts(0u, TraceStatistics(0u, 0u));
    vec3 probe = Probes(wave.probes).at[index / texels].position;
    SeenTexels(wave.texels).at[index] = seen(wave, BakeScenes(wave.scene).at[0], probe, direction, counts);
    countCapped(wave, counts.trace);
}
