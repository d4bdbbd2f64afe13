// Temporal anti-aliasing: frames with different positions within the pixels become one picture (shared/view.glsl.h).
//
// While the camera stands still the picture is the mean of all frames. When it moves, the history is fetched from where
// the point was before, is dropped where another surface was seen there, and is held within the colors around the
// pixel: mean and deviation of the neighbors (Salvi 2016, "An Excursion in Temporal Supersampling").
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

#include "shared/view.glsl.h"
#include "shared/color.glsl.h"

layout(local_size_x = kViewGroupEdge, local_size_y = kViewGroupEdge) in;

layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer Parameters { ResolveParameters resolve; };
layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer Frame { vec4 at[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) writeonly buffer History { vec4 at[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) writeonly buffer Pixels { uint rgba[]; };
layout(push_constant) uniform Push { ResolvePushConstants push; };

const float kFarAway = 1e29;       // of the sky
const float kSameSurface = 0.04;   // two distances are of one surface when they differ by less than this part
const float kDeviations = 1.25;    // that the history may be away from the neighbors

uint indexOf(ResolveParameters r, ivec2 pixel) {
    ivec2 inside = clamp(pixel, ivec2(0), ivec2(r.width, r.height) - 1);
    return uint(inside.y) * r.width + uint(inside.x);
}

// Where the middle of this pixel was in the frame before, in pixels; x < 0 when it was not in the picture.
// `expected` is how far from that camera it was.
vec2 lastPosition(ResolveParameters r, ivec2 pixel, float distance, out float expected) {
    vec2 plane = 2.0 * (vec2(pixel) + 0.5) / vec2(r.width, r.height) - 1.0;
    vec3 direction = normalize(r.forward + plane.x * r.right - plane.y * r.up);
    vec3 v = distance < kFarAway ? r.position + distance * direction - r.lastPosition : direction;
    expected = distance < kFarAway ? length(v) : distance;
    float depth = dot(v, r.lastForward);
    if (depth <= 0.0) return vec2(-1.0);
    vec2 at = vec2(dot(v, r.lastRight) / dot(r.lastRight, r.lastRight),
                   -dot(v, r.lastUp) / dot(r.lastUp, r.lastUp)) / depth;
    vec2 inPixels = (0.5 + 0.5 * at) * vec2(r.width, r.height);
    bool outside = any(lessThan(inPixels, vec2(0.0))) || any(greaterThanEqual(inPixels, vec2(r.width, r.height)));
    return outside ? vec2(-1.0) : inPixels;
}

bool sawTheSame(ResolveParameters r, ivec2 pixel, float expected) {
    for (int y = -1; y <= 1; ++y) {
        for (int x = -1; x <= 1; ++x) {
            float seen = Frame(push.lastFrame).at[indexOf(r, pixel + ivec2(x, y))].w;
            if (abs(seen - expected) <= kSameSurface * expected) return true;
        }
    }
    return false;
}

vec4 historyAt(ResolveParameters r, vec2 position) {
    vec2 p = position - 0.5;
    ivec2 low = ivec2(floor(p));
    vec2 part = p - vec2(low);
    Frame history = Frame(push.lastHistory);
    vec4 upper = mix(history.at[indexOf(r, low)], history.at[indexOf(r, low + ivec2(1, 0))], part.x);
    vec4 lower = mix(history.at[indexOf(r, low + ivec2(0, 1))], history.at[indexOf(r, low + ivec2(1, 1))], part.x);
    return mix(upper, lower, part.y);
}

vec3 heldNearNeighbors(ResolveParameters r, ivec2 pixel, vec3 color) {
    vec3 sum = vec3(0.0);
    vec3 squares = vec3(0.0);
    for (int y = -1; y <= 1; ++y) {
        for (int x = -1; x <= 1; ++x) {
            vec3 c = Frame(push.frame).at[indexOf(r, pixel + ivec2(x, y))].rgb;
            sum += c;
            squares += c * c;
        }
    }
    vec3 mean = sum / 9.0;
    vec3 reach = kDeviations * sqrt(max(squares / 9.0 - mean * mean, vec3(0.0)));
    return clamp(color, mean - reach, mean + reach);
}

// Color and number of frames of what is known from before; 0 frames = nothing.
vec4 knownBefore(ResolveParameters r, ivec2 pixel, float distance) {
    if (r.hasHistory == 0u) return vec4(0.0);
    if (r.moved == 0u) return Frame(push.lastHistory).at[indexOf(r, pixel)];
    float expected;
    vec2 last = lastPosition(r, pixel, distance, expected);
    if (last.x < 0.0 || !sawTheSame(r, ivec2(last), expected)) return vec4(0.0);
    vec4 history = historyAt(r, last);
    return vec4(heldNearNeighbors(r, pixel, history.rgb), min(history.w, float(r.frameLimit) - 1.0));
}

void main() {
    ResolveParameters r = Parameters(push.parameters).resolve;
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (pixel.x >= int(r.width) || pixel.y >= int(r.height)) return;
    uint index = indexOf(r, pixel);
    vec4 frame = Frame(push.frame).at[index];
    vec4 before = knownBefore(r, pixel, frame.w);
    float frames = floor(before.w + 0.5) + 1.0;
    vec3 color = mix(before.rgb, frame.rgb, 1.0 / frames);
    if ((push.history.x | push.history.y) != 0u) History(push.history).at[index] = vec4(color, frames);
    Pixels(push.pixels).rgba[index] = packUnorm4x8(vec4(srgbFromLinear(clamp(color, vec3(0.0), vec3(1.0))), 1.0));
}
