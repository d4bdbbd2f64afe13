// Faces of emissive voxels as light sources that paths look for: the list of libbake/src/bake/emitters.hpp. Reads nothing but a
// BakeScene; what a path makes of what it finds here is its own.
#ifndef PFVOX_EMITTERS_GLSL
#define PFVOX_EMITTERS_GLSL

#include "bake_rays.glsl"

layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer Emitters { EmitterFace at[]; };

bool looksForEmitters(BakeScene bake) { return bake.emitterCount != 0u && bake.sampling != kSampleDirections; }

// The balance heuristic.
float emitterWeight(float pdf, float otherPdf) { return pdf / (pdf + otherPdf); }

EmitterFace pickEmitter(BakeScene bake, float u) {
    float scaled = u * float(bake.emitterCount);
    uint slot = min(uint(scaled), bake.emitterCount - 1u);
    EmitterFace face = Emitters(bake.emitters).at[slot];
    if (scaled - float(slot) < face.threshold) return face;
    return Emitters(bake.emitters).at[face.alias];
}

// Where light is looked for: `toLight` unit, `radiance` 0 where nothing comes.
struct EmitterSample {
    vec3 toLight;
    float pdf;  // per steradian
    vec3 radiance;
    vec3 end;       // of the shadow ray
};

EmitterSample sampleEmitter(BakeScene bake, vec3 origin, float pick, vec2 u) {
    EmitterFace face = pickEmitter(bake, pick);
    vec3 outward = cross(face.edgeU, face.edgeV);
    float area = length(outward);
    outward /= area;
    vec3 point = face.corner + u.x * face.edgeU + u.y * face.edgeV;
    vec3 away = point - origin;
    float squared = dot(away, away);
    EmitterSample found;
    found.toLight = away * inversesqrt(max(squared, 1e-30));
    float cosine = -dot(outward, found.toLight);
    found.radiance = cosine > 0.0 && squared > 0.0 ? face.radiance : vec3(0.0);
    found.pdf = meanOf(face.radiance) / bake.emitterPower * squared / max(cosine, 1e-12);
    found.end = point + face.offset * outward;
    return found;
}

// Density with which sampleEmitter finds the emitter that a path has run into.
float emitterPdf(BakeScene bake, vec3 emission, float metres, float cosine) {
    return meanOf(emission) / bake.emitterPower * metres * metres / max(cosine, 1e-12);
}

#endif
