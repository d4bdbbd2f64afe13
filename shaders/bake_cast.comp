// The rays of one queue: closest hits of paths, or shadow rays and the fraction of their light that arrives.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

#include "bake_wave.glsl"

layout(constant_id = 1) const uint kQueue = kQueueRays;
Ray rayAt(BakeWave wave, uint place) {
    if (kQueue == kQueueRays) {
        uint path = Numbers(wave.rays[push.set]).at[place];
        return Ray(Paths(wave.paths).at[path].origin, kInfinity, Paths(wave.paths).at[path].direction, 0.0);
    }
    ShadowRays rays = ShadowRays(wave.shadowRays[kQueue - kQueueSun]);
    return Ray(rays.at[place].origin, rays.at[place].metres, rays.at[place].direction, 0.0);
}

void castPath(BakeWave wave, Scene scene, uint place, inout RayCounts counts) {
    uint glass = kNoMaterial;
    if (kHasGlass != 0u) glass = Paths(wave.paths).at[Numbers(wave.rays[push.set]).at[place]].lastGlass;
    Ray ray = rayAt(wave, place);
    Hit hit = kHasGlass != 0u ? castThroughGlass(scene, ray, glass, counts) : castRay(scene, ray, counts);
    PathHits(wave.hits).at[place] = PathHit(hit.corner, hit.t, hit.instance, hit.node, uint(hit.scale), hit.axis);
}

void castShadow(BakeWave wave, Scene scene, uint place, inout RayCounts counts) {
    vec3 fraction = transmittance(scene, rayAt(wave, place), counts);
    if (maxOf(fraction) <= 0.0) return;
    ShadowRays rays = ShadowRays(wave.shadowRays[kQueue - kQueueSun]);
    Vectors(wave.arrived).at[rays.at[place].path].rgb += fraction * rays.at[place].light;
}

void main() {
    BakeWave wave = Waves(push.wave).at[0];
    uint place = invocationIndex();
    if (place >= Controls(wave.control).control.waiting[push.set * kQueueKinds + kQueue]) return;
    Scene scene = Scene(BakeScenes(wave.scene).at[0].scene);
    RayCounts counts = RayCounts(0u, TraceStatistics(0u, 0u));
    if (kQueue == kQueueRays) castPath(wave, scene, place, counts);
    else castShadow(wave, scene, place, counts);
    countCapped(wave, counts.trace);
}
