// Light that leaves a surface towards a viewer: emission + albedo * (E_direct / pi + I), and the sun's highlight. With
// PFVOX_VIEW_PROBES defined I comes from the probe field, else it is a guess from the sky.
#ifndef PFVOX_VIEW_LIGHTING_GLSL
#define PFVOX_VIEW_LIGHTING_GLSL

#include "view_frame.glsl"
#ifdef PFVOX_VIEW_PROBES
#include "probe_lookup.glsl"
#else
#include "shared/probes.glsl.h"
struct ProbeLight {
    vec3 indirect;
    vec3 weights;
    uint tier;
};
#endif

// Mean radiance that a Lambert surface sees, by its normal alone: no occlusion. A faint fill from the side keeps the
// faces of a shaded voxel apart.
vec3 ambientRadiance(ViewParameters view, vec3 normal) {
    vec3 above = 0.6 * view.skyZenith + 0.4 * view.skyHorizon;
    float fill = 1.0 + 0.18 * dot(normal, vec3(0.8, 0.0, -0.6));
    return fill * mix(view.skyGround, above, 0.5 + 0.5 * normal.y);
}

// A value that is not finite counts as none.
ProbeLight indirectAt(ViewParameters view, SurfacePart part) {
#ifdef PFVOX_VIEW_PROBES
    ProbeLight light = lookUpProbes(ProbeFieldRef(view.field).field, part.position, part.normal, part.spread);
    if (any(isnan(light.indirect)) || any(isinf(light.indirect))) light = ProbeLight(vec3(0.0), vec3(0.0), kTierNone);
    return light;
#else
    return ProbeLight(ambientRadiance(view, part.normal), vec3(0.0), kTierNone);
#endif
}

// `sun` is the share of it that arrives. Without what mirrors.
vec3 radianceFrom(ViewParameters view, SurfacePart part, vec3 toViewer, vec3 sun, vec3 indirect) {
    Lobes lobes = lobesOf(part.material, part.albedo, part.normal, toViewer);
    vec3 radiance = part.albedo * part.material.emissionStrength + lobes.diffuse * indirect;
    if (maxOf(sun) > 0.0)
        radiance += evaluateLobes(lobes, part.normal, toViewer, -view.sunDirection).value * view.sunIrradiance * sun;
    return radiance;
}

vec3 sunShare(ViewParameters view, Scene scene, SurfacePart part, inout RayCounts counts) {
    if (maxOf(view.sunIrradiance) <= 0.0 || dot(part.normal, -view.sunDirection) <= 0.0) return vec3(0.0);
    Ray ray = Ray(part.start, kInfinity, -view.sunDirection, 0.0);
    return transmittance(scene, ray, counts);
}

#endif
