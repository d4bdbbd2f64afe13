// From radiance to what a screen can show, linear.
#ifndef PFVOX_VIEW_TONE_MAP_GLSL
#define PFVOX_VIEW_TONE_MAP_GLSL

#include "shared/view.glsl.h"

float largestOf(vec3 c) { return max(c.r, max(c.g, c.b)); }

// Straight up to 0.7, then a shoulder that reaches 1 at infinity: colors of the source stay what they are. The curve is
// that of the strongest channel, so that a lamp keeps its hue; only what is far too bright turns towards white.
vec3 standardToneMap(vec3 c) {
    const float knee = 0.7;
    float strongest = largestOf(c);
    if (strongest <= knee) return c;
    float mapped = knee + (1.0 - knee) * (1.0 - exp((knee - strongest) / (1.0 - knee)));
    float glare = 0.6 * (1.0 - exp(-0.12 * (strongest - knee)));
    return mix(c * (mapped / strongest), vec3(mapped), glare);
}

// Reinhard et al. 2002, "Photographic Tone Reproduction for Digital Images", equation 3.
vec3 reinhardToneMap(vec3 c) { return c / (1.0 + dot(c, vec3(0.2126, 0.7152, 0.0722))); }

// Narkowicz 2015, "ACES Filmic Tone Mapping Curve": one rational fit for each channel.
vec3 acesToneMap(vec3 c) { return c * (2.51 * c + 0.03) / (c * (2.43 * c + 0.59) + 0.14); }

// Khronos PBR Neutral (2024): an offset for the Fresnel share of 4 %, compression above 0.8, then desaturation.
vec3 neutralToneMap(vec3 c) {
    const float start = 0.8 - 0.04;
    const float desaturation = 0.15;
    float least = min(c.r, min(c.g, c.b));
    c -= least < 0.08 ? least - 6.25 * least * least : 0.04;
    float peak = largestOf(c);
    if (peak < start) return c;
    const float rest = 1.0 - start;
    float compressed = 1.0 - rest * rest / (peak + rest - start);
    float white = 1.0 - 1.0 / (desaturation * (peak - compressed) + 1.0);
    return mix(c * (compressed / peak), vec3(compressed), white);
}

vec3 toneMap(uint curve, vec3 c) {
    switch (curve) {
        case kToneMapLinear: return min(c, vec3(1.0));
        case kToneMapReinhard: return reinhardToneMap(c);
        case kToneMapAces: return acesToneMap(c);
        case kToneMapNeutral: return neutralToneMap(c);
        default: return standardToneMap(c);
    }
}

#endif
