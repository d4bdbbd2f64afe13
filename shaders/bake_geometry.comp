// What a probe sees: distance, normal, and what leaves each texel's surface without indirect light.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

#include "shared/bake.glsl.h"
#include "shared/probe_maths.glsl.h"
#define PFVOX_TRACE_GROUP_SIZE kBakeGroupSize
#include "bake_rays.glsl"

layout(local_size_x = kBakeGroupSize) in;

layout(buffer_reference, std430, buffer_reference_align = 16) writeonly buffer SeenTexels { SeenTexel at[]; };
layout(push_constant) uniform Push { GeometryPush push; };

SeenTexel seen(BakeScene bake, vec3 direction, inout RayCounts counts) {
    Scene scene = Scene(bake.scene);
    Ray ray = Ray(push.probe, kInfinity, direction, 0.0);
    Hit hit = castRay(scene, ray, counts);
    if (hit.instance == kNoInstance)
        return SeenTexel(vec3(0.0), -1.0, skyRadiance(bake, direction), kDepthMiss, vec3(0.0), 0.0);
    Surface surface = surfaceOf(scene, ray, hit);
    MaterialRecord material = materialOf(scene, surface);
    SeenTexel texel;
    texel.normal = surface.normal;
    texel.metres = hit.t;
    texel.albedo = albedoOf(scene, surface);
    texel.offset = rayOffset(surface);
    texel.word = packDepthNormal(depthCode(hit.t, push.depthScale, push.depthLogRange), surface.normal);
    texel.direct = emissionOf(material);
    if (hasSun(bake, surface.normal)) {
        vec3 sun = sunAt(bake, surface.position + texel.offset * surface.normal, counts);
        texel.direct += texel.albedo * sun * (dot(surface.normal, -bake.sunDirection) / kPi);
    }
    return texel;
}

void main() {
    if (gl_GlobalInvocationID.x >= push.texelCount) return;
    uint index = push.firstTexel + gl_GlobalInvocationID.x;
    RayCounts counts = RayCounts(0u, TraceStatistics(0u, 0u));
    vec3 direction = directionOfTexel(index % push.edge, index / push.edge, push.edge);
    SeenTexels(push.texels).at[index] = seen(BakeScenes(push.scene).at[0], direction, counts);
    if (counts.trace.capped != 0u) atomicAdd(Counters(push.counters).at[0].cappedRays, 1u);
}
