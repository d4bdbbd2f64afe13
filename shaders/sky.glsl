// The sky's one formula, for pictures and bakes (docs/scene.md).
#ifndef PFVOX_SKY_GLSL
#define PFVOX_SKY_GLSL

struct SkyColors {
    vec3 zenith;
    vec3 horizon;
    vec3 ground;
};

// Radiance from a unit direction.
vec3 skyAlong(SkyColors sky, vec3 direction) {
    float up = direction.y;
    if (up >= 0.0) return mix(sky.horizon, sky.zenith, sqrt(up));
    return mix(sky.horizon, sky.ground, smoothstep(0.0, 0.9, -up));
}

#endif
