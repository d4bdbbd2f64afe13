// From linear display colours to what a screen takes.
#ifndef PFVOX_VIEW_ENCODING_GLSL
#define PFVOX_VIEW_ENCODING_GLSL

vec3 srgbFromLinear(vec3 c) {
    c = clamp(c, vec3(0.0), vec3(1.0));
    return mix(12.92 * c, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, greaterThan(c, vec3(0.0031308)));
}

#endif
