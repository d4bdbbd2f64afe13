// Indirect light of a picture twice: looked up in a probe field, and by tracing paths from the same surface points.
//
// The reference shares rays and materials with the baker, but nothing of its sampling: no emitter list, no weights, other
// numbers. Light is what a path runs into, and the sun from the second vertex on. First directions of even and of odd
// samples are two sequences that know nothing of each other: how far their means are apart tells the noise.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

#include "shared/verify.glsl.h"
#define PFVOX_TRACE_GROUP_SIZE (kVerifyGroupEdge * kVerifyGroupEdge)
#include "bake_rays.glsl"
#include "probe_lookup.glsl"

layout(local_size_x = kVerifyGroupEdge, local_size_y = kVerifyGroupEdge) in;

layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer Views { VerifyView at[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) buffer Pixels { VerifyPixel at[]; };
layout(push_constant) uniform Push { VerifyPush push; };

uint randomState;

float random() {  // PCG
    randomState = randomState * 747796405u + 2891336453u;
    uint word = (randomState >> ((randomState >> 28) + 4u) ^ randomState) * 277803737u;
    return float((word >> 22 ^ word) >> 8) / 16777216.0;
}

void seedRandom(uint pixel, uint index) {
    randomState = pixel * 0x9e3779b9u ^ (index + 1u) * 0x85ebca6bu;
    for (int i = 0; i < 3; ++i) random();
}

// True when glass lets the path go on in a straight line or reflects it; false at its Lambert share.
bool referenceGlass(Scene scene, inout Ray ray, Hit hit, Surface surface, MaterialRecord material, inout vec3 throughput,
                    inout uint lastGlass) {
    bool enters = entersGlass(surface, lastGlass);
    lastGlass = surface.material;
    if (enters) {
        if (random() < glassReflectance(material, abs(dot(surface.normal, ray.direction)))) {
            ray = Ray(surface.position + rayOffset(surface) * surface.normal, kInfinity,
                      reflect(ray.direction, surface.normal), 0.0);
            lastGlass = kNoMaterial;
            return true;
        }
        if (random() >= material.transparency) {
            throughput /= max(1.0 - material.transparency, 1e-6);  // lobesOf has the share again
            return false;
        }
        throughput *= material.albedo;
    }
    ray = behindGlass(scene, ray, hit, surface);
    ray.tMax = kInfinity;
    return true;
}

// First directions fill the square evenly (the additive recurrence of the plastic number), from a start by chance.
vec2 firstPair(uint pixel, uint number) {
    randomState = pixel * 0x85ebca6bu ^ ((number & 1u) + 1u) * 0xc2b2ae35u;
    for (int i = 0; i < 3; ++i) random();
    vec2 start = vec2(random(), random());
    uint step = number >> 1;
    // Products in 32 bits of fraction, which wrap around as they should.
    uvec2 walked = uvec2(step * 3242174889u, step * 2447445414u);
    return fract(start + vec2(walked >> 8) / 16777216.0);
}

vec3 referencePath(BakeScene bake, vec3 origin, vec3 normal, vec2 first) {
    Scene scene = Scene(bake.scene);
    RayCounts counts = RayCounts(0u, TraceStatistics(0u, 0u));
    Ray ray = Ray(origin, kInfinity, inFrame(cosineDirection(first), normal), 0.0);
    vec3 throughput = vec3(1.0);
    vec3 total = vec3(0.0);
    uint lastGlass = kNoMaterial;
    uint bounces = 0u;
    for (uint step = 0u; step < 256u; ++step) {
        Hit hit = castRay(scene, ray, counts);
        if (hit.instance == kNoInstance) return total + throughput * skyRadiance(bake, ray.direction);
        Surface surface = surfaceOf(scene, ray, hit);
        MaterialRecord material = materialOf(scene, surface);
        if (letsThrough(material) &&
            referenceGlass(scene, ray, hit, surface, material, throughput, lastGlass)) continue;
        total += throughput * emissionOf(material);
        if (bounces++ >= bake.maxBounces) return total;
        vec3 toViewer = -ray.direction;
        vec3 from = surface.position + rayOffset(surface) * surface.normal;
        Lobes lobes = lobesOf(material, albedoOf(scene, surface), surface.normal, toViewer);
        if (hasSun(bake, surface.normal))
            total += throughput * evaluateLobes(lobes, surface.normal, toViewer, -bake.sunDirection).value *
                     sunAt(bake, from, counts);
        vec3 direction = sampleLobes(lobes, surface.normal, toViewer, vec2(random(), random()), random());
        Scattering s = evaluateLobes(lobes, surface.normal, toViewer, direction);
        if (maxOf(s.value) <= 0.0) return total;
        throughput *= s.value / s.density;
        if (bounces >= kRouletteBounce) {
            float survival = min(maxOf(throughput), 0.95);
            if (random() >= survival) return total;
            throughput /= survival;
        }
        ray = Ray(from, kInfinity, direction, 0.0);
        lastGlass = kNoMaterial;
    }
    return total;
}

void main() {
    VerifyView view = Views(push.view).at[0];
    uvec2 pixel = gl_GlobalInvocationID.xy + uvec2(0u, push.firstRow);
    if (pixel.x >= view.width || pixel.y >= view.height) return;
    uint index = pixel.y * view.width + pixel.x;
    BakeScene bake = BakeScenes(push.scene).at[0];
    Scene scene = Scene(bake.scene);
    vec2 plane = 2.0 * (vec2(pixel) + 0.5) / vec2(view.width, view.height) - 1.0;
    Ray ray = Ray(view.position, kInfinity, normalize(view.forward + plane.x * view.right - plane.y * view.up), 0.0);
    RayCounts counts = RayCounts(0u, TraceStatistics(0u, 0u));
    Hit hit = castRay(scene, ray, counts);
    if (push.sampleCount == 0u) {
        VerifyPixel fresh = VerifyPixel(vec4(vec3(0.0), -1.0), vec4(0.0), vec4(0.0), 0u, 0u, 0u, 0u);
        if (hit.instance != kNoInstance) {
            Surface surface = surfaceOf(scene, ray, hit);
            ProbeLight light = lookUpProbes(ProbeFieldRef(push.field).field, surface.position, surface.normal);
            fresh.lookup = vec4(light.indirect, float(light.tier));
            fresh.material = materialOf(scene, surface).type;
        }
        Pixels(push.pixels).at[index] = fresh;
        return;
    }
    if (hit.instance == kNoInstance) return;
    Surface surface = surfaceOf(scene, ray, hit);
    vec3 origin = surface.position + rayOffset(surface) * surface.normal;
    vec4 even = vec4(0.0);
    vec4 odd = vec4(0.0);
    for (uint i = 0u; i < push.sampleCount; ++i) {
        uint number = push.firstSample + i;
        vec2 first = firstPair(index, number);
        seedRandom(index, number);
        vec4 light = vec4(referencePath(bake, origin, surface.normal, first), 1.0);
        if ((number & 1u) == 0u) even += light;
        else odd += light;
    }
    Pixels(push.pixels).at[index].even += even;
    Pixels(push.pixels).at[index].odd += odd;
}
