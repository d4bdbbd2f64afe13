// What the programs of the baker and of verify share: rays that start off surfaces and go through glass, sky, and the sun. The
// includer defines PFVOX_TRACE_GROUP_SIZE.
#ifndef PFVOX_BAKE_RAYS_GLSL
#define PFVOX_BAKE_RAYS_GLSL

#include "shared/bake.glsl.h"
#include "octree_trace.glsl"
#include "material.glsl"

// Scenes without glass take one any-hit ray for a shadow.
layout(constant_id = 0) const uint kHasGlass = 0u;

layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer BakeScenes { BakeScene at[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer Emitters { EmitterFace at[]; };

struct RayCounts {
    uint rays;
    TraceStatistics trace;
};

vec3 skyRadiance(BakeScene bake, vec3 direction) {
    float up = direction.y;
    if (up >= 0.0) return mix(bake.skyHorizon, bake.skyZenith, sqrt(up));
    return mix(bake.skyHorizon, bake.skyGround, smoothstep(0.0, 0.9, -up));
}

Hit castRay(Scene scene, Ray ray, inout RayCounts counts) {
    ++counts.rays;
    return traceClosest(scene, ray, counts.trace);
}

MaterialRecord materialOf(Scene scene, Surface surface) { return Materials(scene.header.materials).at[surface.material]; }

// How far a ray starts off a surface, along its normal.
float rayOffset(Surface surface) {
    return max(kRayOffsetVoxels * surface.voxelMetres, 4e-7 * maxOf(abs(surface.position)));
}

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

// Share of the light that comes through along a ray of unit direction, by colour.
vec3 transmittance(Scene scene, Ray ray, inout RayCounts counts) {
    if (kHasGlass == 0u) {
        ++counts.rays;
        return traceAny(scene, ray, counts.trace) ? vec3(0.0) : vec3(1.0);
    }
    vec3 through = vec3(1.0);
    uint lastGlass = kNoMaterial;
    for (uint i = 0u; i < kMaxGlassSteps; ++i) {
        Hit hit = castRay(scene, ray, counts);
        if (hit.instance == kNoInstance) return through;
        Surface surface = surfaceOf(scene, ray, hit);
        MaterialRecord material = materialOf(scene, surface);
        if (!letsThrough(material)) return vec3(0.0);
        if (entersGlass(surface, lastGlass)) {
            float cosine = abs(dot(surface.normal, ray.direction));
            through *= (1.0 - glassReflectance(material, cosine)) * glassTint(material);
        }
        lastGlass = surface.material;
        ray = behindGlass(scene, ray, hit, surface);
        if (ray.tMax <= 0.0) return through;
    }
    return vec3(0.0);
}

// Irradiance of the sun at normal incidence, as it arrives at a point.
vec3 sunAt(BakeScene bake, vec3 origin, inout RayCounts counts) {
    return bake.sunIrradiance * transmittance(Scene(bake.scene), Ray(origin, kInfinity, -bake.sunDirection, 0.0), counts);
}

bool hasSun(BakeScene bake, vec3 normal) {
    return maxOf(bake.sunIrradiance) > 0.0 && dot(normal, -bake.sunDirection) > 0.0;
}

#endif
