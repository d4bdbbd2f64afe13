// Colors that stand for figures.
#ifndef PFVOX_VIEW_COLORS_GLSL
#define PFVOX_VIEW_COLORS_GLSL

#include "shared/probes.glsl.h"

uint hash(uint x) {
    x = (x ^ x >> 16) * 0x7feb352du;
    x = (x ^ x >> 15) * 0x846ca68bu;
    return x ^ x >> 16;
}

// A color for an index: neighboring indices look different.
vec3 indexColor(uint index) {
    float hue = fract(float(index) * 0.61803399);
    float value = 0.55 + 0.45 * fract(float(hash(index) & 0xffffu) / 65536.0);
    return value * (0.5 + 0.5 * cos(2.0 * kPi * (hue + vec3(0.0, 0.33, 0.67))));
}

// 0 = dark blue, 1 = white, through green, yellow and red.
vec3 heatColor(float x) {
    x = clamp(x, 0.0, 1.0);
    vec3 cold = mix(vec3(0.01, 0.01, 0.10), vec3(0.02, 0.35, 0.20), smoothstep(0.0, 0.35, x));
    vec3 warm = mix(vec3(0.90, 0.75, 0.05), vec3(0.85, 0.05, 0.02), smoothstep(0.5, 0.85, x));
    return mix(mix(cold, warm, smoothstep(0.25, 0.6, x)), vec3(1.0), smoothstep(0.85, 1.0, x));
}

// Keeps the faces of a flat color apart.
float faceShade(vec3 normal) { return 0.75 + 0.25 * dot(normal, vec3(0.36, 0.8, 0.48)); }

const vec3 kBackground = vec3(0.02);

// What a picture of the tiers shows: turquoise faces, green texels, yellow traced, blue the eight around, red the nearest, magenta none.
vec3 tierColor(uint tier) {
    if (tier == kTierFaces) return vec3(0.10, 0.62, 0.62);
    if (tier == kTierTexels) return vec3(0.20, 0.62, 0.24);
    if (tier == kTierTraced) return vec3(0.85, 0.75, 0.15);
    if (tier == kTierCompact) return vec3(0.16, 0.36, 0.78);
    return tier == kTierNearest ? vec3(0.80, 0.18, 0.12) : vec3(1.0, 0.0, 1.0);
}

#endif
