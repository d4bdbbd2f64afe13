// Light and colour of the viewer's pictures: direct sun with a hard shadow, a cheap sky, and the inspection modes.
#ifndef PFVOX_VIEW_SHADING_GLSL
#define PFVOX_VIEW_SHADING_GLSL

#include "shared/view.glsl.h"
#include "view_encoding.glsl"
#define PFVOX_TRACE_GROUP_SIZE (kViewGroupEdge * kViewGroupEdge)
#define PFVOX_TRACE_LOD
#include "octree_trace.glsl"

const float kPi = 3.14159265;

uint hash(uint x) {
    x = (x ^ x >> 16) * 0x7feb352du;
    x = (x ^ x >> 15) * 0x846ca68bu;
    return x ^ x >> 16;
}

// A colour for an index: neighbouring indices look different.
vec3 indexColour(uint index) {
    float hue = fract(float(index) * 0.61803399);
    float value = 0.55 + 0.45 * fract(float(hash(index) & 0xffffu) / 65536.0);
    return value * (0.5 + 0.5 * cos(2.0 * kPi * (hue + vec3(0.0, 0.33, 0.67))));
}

// 0 = dark blue, 1 = white, through green, yellow and red.
vec3 heatColour(float x) {
    x = clamp(x, 0.0, 1.0);
    vec3 cold = mix(vec3(0.01, 0.01, 0.10), vec3(0.02, 0.35, 0.20), smoothstep(0.0, 0.35, x));
    vec3 warm = mix(vec3(0.90, 0.75, 0.05), vec3(0.85, 0.05, 0.02), smoothstep(0.5, 0.85, x));
    return mix(mix(cold, warm, smoothstep(0.25, 0.6, x)), vec3(1.0), smoothstep(0.85, 1.0, x));
}

vec3 skyRadiance(ViewParameters view, vec3 direction) {
    float up = direction.y;
    if (up >= 0.0) return mix(view.skyHorizon, view.skyZenith, sqrt(up));
    return mix(view.skyHorizon, view.skyGround, smoothstep(0.0, 0.9, -up));
}

// Mean radiance that a Lambert surface sees, by its normal alone: no occlusion. A faint fill from the side keeps the
// faces of a shaded voxel apart.
vec3 ambientRadiance(ViewParameters view, vec3 normal) {
    vec3 above = 0.6 * view.skyZenith + 0.4 * view.skyHorizon;
    float fill = 1.0 + 0.18 * dot(normal, vec3(0.8, 0.0, -0.6));
    return fill * mix(view.skyGround, above, 0.5 + 0.5 * normal.y);
}

float sunVisibility(ViewParameters view, Scene scene, Surface surface, inout TraceStatistics statistics) {
    // Off the surface by a part of a voxel, and by what the float position may be wrong.
    float offset = max(0.002 * surface.voxelMetres, 4e-7 * maxOf(abs(surface.position)));
    Ray ray = Ray(surface.position + offset * surface.normal, kInfinity, -view.sunDirection, 0.0);
    return traceAny(scene, ray, statistics) ? 0.0 : 1.0;
}

vec3 litRadiance(ViewParameters view, Scene scene, Surface surface, inout TraceStatistics statistics) {
    MaterialRecord material = Materials(scene.header.materials).at[surface.material];
    vec3 albedo = albedoOf(scene, surface);
    vec3 radiance = albedo * (ambientRadiance(view, surface.normal) + material.emissionStrength);
    float cosine = dot(surface.normal, -view.sunDirection);
    if (cosine > 0.0 && maxOf(view.sunIrradiance) > 0.0) {
        float visible = sunVisibility(view, scene, surface, statistics);
        radiance += albedo * view.sunIrradiance * (visible * cosine / kPi);
    }
    return radiance;
}

// Straight up to 0.7, then a shoulder that reaches 1 at infinity: colours of the source stay what they are. The curve is
// that of the strongest channel, so that a lamp keeps its hue; only what is far too bright turns towards white.
vec3 toneMap(vec3 radiance) {
    const float knee = 0.7;
    float strongest = maxOf(radiance);
    if (strongest <= knee) return radiance;
    float mapped = knee + (1.0 - knee) * (1.0 - exp((knee - strongest) / (1.0 - knee)));
    float glare = 0.6 * (1.0 - exp(-0.12 * (strongest - knee)));
    return mix(radiance * (mapped / strongest), vec3(mapped), glare);
}

// Of a colour that is meant for the screen as it is: the encoding at the end is taken back.
vec3 linearFromDisplay(vec3 c) { return pow(c, vec3(2.2)); }

// Hot = one voxel, cold = 64 and more. Dark where the cell is a leaf of the file and no level of detail.
vec3 cellColour(Surface surface) {
    vec3 colour = heatColour(0.8 * (1.0 - float(surface.leafLog2) / 6.0));
    return surface.lodColor != 0u ? colour : 0.3 * colour;
}

// Linear display colour of one camera ray, tone mapped where it is radiance. Its distance is kInfinity for the sky.
vec3 viewColour(ViewParameters view, Scene scene, Ray ray, inout TraceStatistics statistics, out float distance) {
    Hit hit = traceClosest(scene, ray, statistics);
    bool struck = hit.instance != kNoInstance;
    distance = struck ? hit.t : kInfinity;
    if (view.mode == kViewSteps) return heatColour(float(statistics.steps) / view.stepScale);
    if (!struck) {
        bool background = view.mode == kViewFinal || view.mode == kViewAlbedo;
        return background ? toneMap(view.exposure * skyRadiance(view, ray.direction)) : vec3(0.02);
    }
    Surface surface = surfaceOf(scene, ray, hit);
    switch (view.mode) {
        case kViewAlbedo: return albedoOf(scene, surface);
        case kViewNormals: return linearFromDisplay(0.5 + 0.5 * surface.normal);
        case kViewMaterial: return linearFromDisplay(indexColour(surface.material));
        case kViewDepth: return heatColour(1.0 - float(octreeLeafLog2(scene, hit)) / 7.0);
        case kViewLod: return cellColour(surface) * (0.75 + 0.25 * dot(surface.normal, vec3(0.36, 0.8, 0.48)));
        default: return toneMap(view.exposure * litRadiance(view, scene, surface, statistics));
    }
}

#endif
