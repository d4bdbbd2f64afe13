// Indirect light of a picture twice: looked up in a probe field, and by tracing paths from the same surface points.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

#include "shared/verify.glsl.h"
#define PFVOX_TRACE_GROUP_SIZE (kVerifyGroupEdge * kVerifyGroupEdge)
#include "reference_path.glsl"
#include "face_lookup.glsl"
#include "probe_lookup.glsl"

layout(local_size_x = kVerifyGroupEdge, local_size_y = kVerifyGroupEdge) in;

layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer Views { VerifyView at[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) buffer Pixels { VerifyPixel at[]; };
layout(push_constant) uniform Push { VerifyPush push; };

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
            if ((push.faces.x | push.faces.y) != 0u) {
                FaceLight light = faceLightOf(FaceFields(push.faces).field, scene, ray, hit);
                fresh.lookup = vec4(light.indirect, float(light.known ? kTierFaces : kTierNone));
            } else {
                ProbeLight light = lookUpProbes(ProbeFieldRef(push.field).field, surface.position, surface.normal, 0.0);
                fresh.lookup = vec4(light.indirect, float(light.tier));
            }
            fresh.material = materialOf(scene, surface).type;
        }
        Pixels(push.pixels).at[index] = fresh;
        return;
    }
    if (hit.instance == kNoInstance) return;
    Surface surface = surfaceOf(scene, ray, hit);
    vec3 origin = startOf(surface);
    // On from what is there: the sums do not depend on how samples are cut into dispatches.
    vec4 even = Pixels(push.pixels).at[index].even;
    vec4 odd = Pixels(push.pixels).at[index].odd;
    for (uint i = 0u; i < push.sampleCount; ++i) {
        uint number = push.firstSample + i;
        vec2 first = firstPair(index, number);
        seedRandom(index, number);
        vec4 light = vec4(referenceLight(bake, origin, surface.normal, first), 1.0);
        if ((number & 1u) == 0u) even += light;
        else odd += light;
    }
    Pixels(push.pixels).at[index].even = even;
    Pixels(push.pixels).at[index].odd = odd;
}
