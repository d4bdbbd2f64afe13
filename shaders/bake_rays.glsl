// What the programs of the baker and of verify share: rays that start off surfaces and go through glass, sky, and the sun. The
// includer defines PFVOX_TRACE_GROUP_SIZE.
#ifndef PFVOX_BAKE_RAYS_GLSL
#define PFVOX_BAKE_RAYS_GLSL

#include "shared/bake.glsl.h"
#include "shared/probe_maths.glsl.h"
#include "octree_trace.glsl"
#include "material.glsl"
#include "sky.glsl"

// Scenes without glass take one any-hit ray for a shadow.
layout(constant_id = 0) const uint kHasGlass = 0u;

layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer BakeScenes { BakeScene at[]; };

struct RayCounts {
    uint rays;
    TraceStatistics trace;
};

vec3 skyRadiance(BakeScene bake, vec3 direction) {
    return skyAlong(SkyColors(bake.skyZenith, bake.skyHorizon, bake.skyGround), direction);
}

Hit castRay(Scene scene, Ray ray, inout RayCounts counts) {
    ++counts.rays;
    return traceClosest(scene, ray, counts.trace);
}

// Finer than packNormal: what directions are drawn about.
uint packWideNormal(vec3 normal) { return packSnorm2x16(octEncode(normal)); }
vec3 unpackWideNormal(uint word) { return octDecode(unpackSnorm2x16(word)); }

MaterialRecord materialOf(Scene scene, Surface surface) { return Materials(scene.header.materials).at[surface.material]; }

// Where a ray leaves the cell that it has hit.
float exitOf(Scene scene, Ray ray, Hit hit) {
    InstanceRecord instance = Instances(scene.header.instances).at[hit.instance];
    vec3 origin = cubeFromWorldPoint(instance, ray.origin);
    vec3 direction = cubeFromWorldVector(instance, ray.direction);
    vec3 inverse = 1.0 / (boundedDirection(direction / maxOf(abs(direction))) * maxOf(abs(direction)));
    vec3 far = mix(hit.corner, hit.corner + edgeOf(hit.scale), greaterThan(direction, vec3(0.0)));
    return max(minOf((far - origin) * inverse), hit.t);
}

// Behind the voxel of glass that a ray of unit direction has hit.
Ray behindGlass(Scene scene, Ray ray, Hit hit, Surface surface) {
    float step = exitOf(scene, ray, hit) + 0.5 * kRayOffsetVoxels * surface.voxelMetres;
    return Ray(ray.origin + step * ray.direction, ray.tMax - step, ray.direction, 0.0);
}

// One body of glass is one sheet: only what a ray enters from outside counts.
bool entersGlass(Surface surface, uint lastGlass) { return surface.face != kFaceInside || surface.material != lastGlass; }

// Fraction of the light that a sheet of glass lets straight on, by color. Directions of unit length.
vec3 sheetTransmittance(MaterialRecord glass, vec3 normal, vec3 direction) {
    return (1.0 - glassReflectance(glass, abs(dot(normal, direction)))) * glassTint(glass);
}

// A ray that looks through glass, and what it still lets through.
struct GlassWalk {
    Ray ray;
    vec3 through;
    uint lastGlass;
};

// True when what was hit is glass and the ray goes on behind it; `enters`: as another body than the last one.
bool goOnThroughGlass(Scene scene, inout GlassWalk walk, Hit hit, Surface surface, MaterialRecord material, out bool enters) {
    enters = false;
    if (kHasGlass == 0u || !letsThrough(material)) return false;
    enters = entersGlass(surface, walk.lastGlass);
    if (enters) walk.through *= sheetTransmittance(material, surface.normal, walk.ray.direction);
    walk.lastGlass = surface.material;
    walk.ray = behindGlass(scene, walk.ray, hit, surface);
    return true;
}

// Fraction of the light that comes through one model, by color.
vec3 transmittanceOfModel(Scene scene, uint instance, Ray ray, inout Walk walk, inout RayCounts counts) {
    vec3 through = vec3(1.0);
    uint lastGlass = kNoMaterial;  // of the cell before, when there is nothing in between
    uint lastStep = counts.trace.steps + kMaxTraceSteps;
    while (++counts.trace.steps != lastStep) {
        uint state = stepWalk(walk);
        if (state == kWalkGoesOn) lastGlass = kNoMaterial;
        if (state == kWalkHit) {
            Hit hit;
            takeHit(walk, hit);
            hit.instance = instance;
            Surface surface = surfaceOf(scene, ray, hit);
            MaterialRecord material = materialOf(scene, surface);
            if (!letsThrough(material)) return vec3(0.0);
            if (surface.material != lastGlass) through *= sheetTransmittance(material, surface.normal, ray.direction);
            lastGlass = surface.material;
            state = passCell(walk);
        }
        if (state == kWalkLeft) return through;
    }
    counts.trace.stepLimitReached = 1u;
    return vec3(0.0);
}

// Fraction of the light that comes through along a ray of unit direction, by color.
vec3 transmittance(Scene sceneBuffer, Ray ray, inout RayCounts counts) {
    ++counts.rays;
    if (kHasGlass == 0u) return traceAny(sceneBuffer, ray, counts.trace) ? vec3(0.0) : vec3(1.0);
    SceneHeader scene = sceneBuffer.header;
    SceneWalk walk = beginSceneWalk(scene, ray);
    vec3 through = vec3(1.0);
    while (maxOf(through) > 0.0 && enterNextModel(scene, walk))
        through *= transmittanceOfModel(sceneBuffer, instanceOf(walk), ray, walk.model, counts);
    return through;
}

// True when a walk that begins in glass of this material has come to something else; false when it has ended there.
bool leaveGlass(Scene scene, uint instance, Ray ray, uint glass, inout Walk walk) {
    if (walk.tEnter > 0.0) return true;  // it begins elsewhere
    for (uint i = 0u; i < kMaxTraceSteps; ++i) {
        Walk ahead = walk;
        if (stepWalk(ahead) != kWalkHit) return true;
        Hit hit;
        takeHit(ahead, hit);
        hit.instance = instance;
        if (surfaceOf(scene, ray, hit).material != glass) return true;
        if (passCell(ahead) == kWalkLeft) return false;
        walk = ahead;
    }
    return false;
}

// The closest hit of a ray that goes on through the glass that it begins in: `glass`, a material or kNoMaterial.
Hit castThroughGlass(Scene sceneBuffer, Ray ray, uint glass, inout RayCounts counts) {
    if (glass == kNoMaterial) return castRay(sceneBuffer, ray, counts);
    ++counts.rays;
    SceneHeader scene = sceneBuffer.header;
    SceneWalk walk = beginSceneWalk(scene, ray);
    while (enterNextModel(scene, walk)) {
        if (!leaveGlass(sceneBuffer, instanceOf(walk), ray, glass, walk.model)) continue;
        leaveModel(walk, finishWalk(walk.model, counts.trace));
    }
    return walk.hit;
}

// Irradiance of the sun at normal incidence, as it arrives at a point.
vec3 sunAt(BakeScene bake, vec3 origin, inout RayCounts counts) {
    return bake.sunIrradiance * transmittance(Scene(bake.scene), Ray(origin, kInfinity, -bake.sunDirection, 0.0), counts);
}

bool hasSun(BakeScene bake, vec3 normal) {
    return maxOf(bake.sunIrradiance) > 0.0 && dot(normal, -bake.sunDirection) > 0.0;
}

#endif
