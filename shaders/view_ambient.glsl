// Indirect light where no probes say it: a guess for a first look, by rays that find out what hides the sky near by and
// by looking for faces that emit. What is wrong with it: one bounce, by a guess of the sky; beyond the reach nothing hides
// the sky; the sun does not bounce.
#ifndef PFVOX_VIEW_AMBIENT_GLSL
#define PFVOX_VIEW_AMBIENT_GLSL

#include "emitters.glsl"

const uint kLampCandidates = 4u;     // of which one gets a ray, by the light that it would give
const float kBounceFraction = 0.6;      // of the guess for an open surface, at what is near another one
const float kNearestLamp = 0.1;      // of a voxel's area: nearer faces give no more than from there

// A faint fill from the side keeps the faces of a shaded voxel apart.
float fillOf(vec3 normal) { return 1.0 + 0.18 * dot(normal, vec3(0.8, 0.0, -0.6)); }

// Mean radiance that a Lambert surface sees, by its normal alone: no occlusion.
vec3 ambientRadiance(ViewParameters view, vec3 normal) {
    vec3 above = 0.6 * view.skyZenith + 0.4 * view.skyHorizon;
    return fillOf(normal) * mix(view.skyGround, above, 0.5 + 0.5 * normal.y);
}

// Everything but emission that comes along a ray that ends at the reach.
vec3 nearbyRadiance(ViewParameters view, Scene scene, Ray ray, inout RayCounts counts) {
    vec3 sky = skyRadiance(view, ray.direction);
    Hit hit = castRay(scene, ray, counts);
    float ground = groundAlong(view, ray);
    if (min(hit.t, ground) >= ray.tMax) return sky;
    vec3 bounced = kGroundAlbedo * ambientRadiance(view, kGroundNormal);
    if (hit.t <= ground) {
        Surface surface = surfaceOf(scene, ray, hit);
        MaterialRecord material = materialOf(scene, surface);
        if (kHasGlass != 0u && letsThrough(material)) return glassTint(material) * sky;
        bounced = albedoOf(scene, surface) * ambientRadiance(view, surface.normal);
    }
    float open = min(hit.t, ground) / ray.tMax;
    return mix(kBounceFraction * bounced, sky, open * open);
}

// I of all emitters: of a few candidates one is picked by what it would give unhidden (Talbot et al. 2005, "Importance
// Resampling for Global Illumination").
vec3 lampLight(ViewParameters view, Scene scene, SurfacePart part, uint key, uint index, inout RayCounts counts) {
    BakeScene lamps;  // what emitters.glsl reads of it
    lamps.emitters = view.emitters;
    lamps.emitterCount = view.emitterCount;
    lamps.emitterPower = view.emitterPower;
    vec3 origin = part.start;
    float least = kNearestLamp * part.cellMetres * part.cellMetres / view.emitterPower;
    vec2 chance = sobolPair(joinHash(key, 1u), index);
    vec3 light = vec3(0.0);  // of the one picked, its mean channel 1
    vec3 end = origin;
    float sum = 0.0;
    for (uint i = 0u; i < kLampCandidates; ++i) {
        float pick = (float(i) + chance.x) / float(kLampCandidates);
        EmitterSample face = sampleEmitter(lamps, origin, pick, hashPair(joinHash(key, 2u), kLampCandidates * index + i));
        float cosine = dot(part.normal, face.toLight);
        if (cosine <= 0.0 || maxOf(face.radiance) <= 0.0) continue;
        vec3 given = face.radiance * (cosine / (kPi * max(face.pdf, least * meanOf(face.radiance))));
        float weight = meanOf(given);
        sum += weight;
        float fraction = weight / sum;
        bool taken = chance.y < fraction;
        chance.y = taken ? chance.y / fraction : (chance.y - fraction) / max(1.0 - fraction, 1e-6);
        if (!taken) continue;
        light = given / weight;
        end = face.end;
    }
    if (sum <= 0.0) return vec3(0.0);
    vec3 away = end - origin;
    float metres = max(length(away), 1e-12);
    return (sum / float(kLampCandidates)) * light * transmittance(scene, Ray(origin, metres, away / metres, 0.0), counts);
}

// I = E / pi at a surface. `key` stands for the pixel and what it is that is asked.
vec3 guessedIndirect(ViewParameters view, Scene scene, SurfacePart part, uint key, inout RayCounts counts) {
    vec3 nearby = vec3(0.0);
    vec3 lamps = vec3(0.0);
    for (uint i = 0u; i < view.ambientRays; ++i) {
        uint index = sampleNumber(view) * view.ambientRays + i;
        vec3 direction = inFrame(cosineDirection(sobolPair(key, index)), part.normal);
        nearby += nearbyRadiance(view, scene, Ray(part.start, view.ambientReach, direction, 0.0), counts);
        if (view.emitterCount != 0u) lamps += lampLight(view, scene, part, key, index, counts);
    }
    return (fillOf(part.normal) * nearby + lamps) / float(max(view.ambientRays, 1u));
}

#endif
