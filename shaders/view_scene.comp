// The viewer's picture: one invocation a pixel, several camera rays each (shared/view.glsl.h).
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

#include "view_shading.glsl"

layout(local_size_x = kViewGroupEdge, local_size_y = kViewGroupEdge) in;

layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer Parameters { ViewParameters view; };
layout(buffer_reference, std430, buffer_reference_align = 16) writeonly buffer Pixels { uint rgba[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) buffer Counters { ViewCounters counters; };
layout(buffer_reference, std430, buffer_reference_align = 16) writeonly buffer Linear { vec4 at[]; };
layout(push_constant) uniform Push { ViewPushConstants push; };

// Samples spread evenly over the pixel: the additive recurrence with the plastic number (Roberts 2018). The first lies
// in the middle.
vec2 samplePosition(uint index) { return fract(vec2(0.5) + float(index) * vec2(0.7548776662, 0.5698402910)); }

Ray cameraRay(ViewParameters view, uvec2 pixel, vec2 within) {
    vec2 plane = 2.0 * (vec2(pixel) + within) / vec2(view.width, view.height) - 1.0;
    vec3 direction = view.cameraForward + plane.x * view.cameraRight - plane.y * view.cameraUp;
    return Ray(view.cameraPosition, kInfinity, normalize(direction), view.cone);
}

void count(TraceStatistics statistics, uint hits, uint cappedRays, uint samples) {
    Counters counters = Counters(push.counters);
    atomicAdd(counters.counters.primaryHits, hits);
    if (cappedRays != 0u) atomicAdd(counters.counters.cappedRays, cappedRays);
    uint before = atomicAdd(counters.counters.stepsLow, statistics.steps);
    if (before + statistics.steps < before) atomicAdd(counters.counters.stepsHigh, 1u);
    before = atomicAdd(counters.counters.raysLow, samples);
    if (before + samples < before) atomicAdd(counters.counters.raysHigh, 1u);
}

void main() {
    ViewParameters view = Parameters(push.parameters).view;
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= view.width || pixel.y >= view.height) return;

    vec3 sum = vec3(0.0);
    uint hits = 0u;
    uint cappedRays = 0u;
    float nearest = kInfinity;
    TraceStatistics total = TraceStatistics(0u, 0u);
    for (uint i = 0u; i < view.samplesPerPixel; ++i) {
        TraceStatistics statistics = TraceStatistics(0u, 0u);
        float distance;
        Ray ray = cameraRay(view, pixel, samplePosition(view.firstSample + i));
        sum += viewColour(view, Scene(push.scene), ray, statistics, distance);
        hits += uint(distance < kInfinity);
        nearest = min(nearest, distance);
        cappedRays += statistics.capped;
        total.steps += statistics.steps;
    }
    count(total, hits, cappedRays, view.samplesPerPixel);
    vec3 mean = sum / float(view.samplesPerPixel);
    uint index = pixel.y * view.width + pixel.x;
    if ((push.linear.x | push.linear.y) != 0u) {
        Linear(push.linear).at[index] = vec4(mean, nearest);
    } else {
        Pixels(push.pixels).rgba[index] = packUnorm4x8(vec4(srgbFromLinear(mean), 1.0));
    }
}
