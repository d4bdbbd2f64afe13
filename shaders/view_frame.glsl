// What all programs of a picture share: parameters, camera rays, what earlier passes left, sums for statistics.
#ifndef PFVOX_VIEW_FRAME_GLSL
#define PFVOX_VIEW_FRAME_GLSL

#include "shared/view.glsl.h"
#include "shared/probe_maths.glsl.h"
#include "shared/sampling.glsl.h"
#define PFVOX_TRACE_GROUP_SIZE (kViewGroupEdge * kViewGroupEdge)
#define PFVOX_TRACE_LOD
#include "bake_rays.glsl"
#include "face_lookup.glsl"
#include "view_ground.glsl"
#include "view_tone_map.glsl"

layout(local_size_x = kViewGroupEdge, local_size_y = kViewGroupEdge) in;

layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer Parameters { ViewParameters view; };
layout(buffer_reference, std430, buffer_reference_align = 16) buffer Colors { vec4 at[]; };
layout(buffer_reference, std430, buffer_reference_align = 8) buffer Counts { uvec2 at[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) buffer SeenPixels { SeenPixel at[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) buffer SeenShines { SeenShine at[]; };
layout(push_constant) uniform Push { ViewPushConstants push; };

// Light of faces says what is indirect; else probes or a guess.
layout(constant_id = 1) const uint kHasFaces = 0u;

// ---- Pixels and camera rays ----

struct Pixel {
    uvec2 at;     // in the picture
    uint index;   // in the buffers
    bool inside;
};

Pixel pixelOf(ViewParameters view) {
    uvec2 within = gl_GlobalInvocationID.xy;
    return Pixel(within + uvec2(0u, push.firstRow), within.y * view.width + within.x,
                 within.x < view.width && within.y < push.rowCount);
}

// Samples spread evenly over the pixel: the additive recurrence with the plastic number (Roberts 2018). The first lies
// in the middle.
vec2 samplePosition(uint index) { return fract(vec2(0.5) + float(index) * vec2(0.7548776662, 0.5698402910)); }

uint sampleNumber(ViewParameters view) { return view.firstSample + push.sampleIndex; }

// Of random numbers: neighboring pixels have nothing in common.
uint pixelKey(uvec2 pixel) { return pcgHash(pixel.x + (pixel.y << 16)); }

Ray cameraRay(ViewParameters view, uvec2 pixel) {
    vec2 within = samplePosition(sampleNumber(view));
    vec2 plane = 2.0 * (vec2(pixel) + within) / vec2(view.width, view.height) - 1.0;
    vec3 direction = view.cameraForward + plane.x * view.cameraRight - plane.y * view.cameraUp;
    return Ray(view.cameraPosition, kInfinity, normalize(direction), view.cone);
}

vec3 skyRadiance(ViewParameters view, vec3 direction) {
    return skyAlong(SkyColors(view.skyZenith, view.skyHorizon, view.skyGround), direction);
}

// ---- What is handed from pass to pass ----

// I of the face that was hit, kFaceNoValue where there is none.
uint faceWord(ViewParameters view, Scene scene, Ray ray, Hit hit) {
    if (kHasFaces == 0u) return 0u;
    FaceLight light = faceLightOf(FaceFields(view.faces).field, scene, ray, hit);
    return light.known ? packRgb9e5(light.indirect) : kFaceNoValue;
}
vec3 lightOfWord(uint word) { return word == kFaceNoValue ? vec3(0.0) : unpackRgb9e5(word); }

// Extent of a cell along its normal, as the upper half of a float, and where its rays start, by components of five bits in parts
// of two ray offsets. Of a level of detail, what it stands for: rays start as much farther off it.
uint packCell(float metres, vec3 lift) {
    uvec3 parts = uvec3(ivec3(round(clamp(0.5 * lift, -1.0, 1.0) * 15.0))) & 31u;
    return (floatBitsToUint(metres) + 0x8000u & 0xffff0000u) | parts.x | parts.y << 5 | parts.z << 10;
}
uint packCell(Surface surface) {
    float metres = surface.lodColor != 0u ? exp2(float(surface.leafLog2)) * surface.voxelMetres : surface.voxelMetres;
    return packCell(metres, surface.lift / rayOffset(surface.voxelMetres, surface.position));
}
float metresOfCell(uint cell) { return uintBitsToFloat(cell & 0xffff0000u); }
vec3 startOfRays(vec3 position, uint cell) {
    vec3 parts = vec3(bitfieldExtract(int(cell), 0, 5), bitfieldExtract(int(cell), 5, 5), bitfieldExtract(int(cell), 10, 5));
    return position + 2.0 / 15.0 * rayOffset(metresOfCell(cell), position) * parts;
}

// A point on a surface as passes hand it on.
struct SurfacePart {
    vec3 position;
    vec3 normal;
    vec3 start;        // of rays that leave it
    float cellMetres;  // extent of the voxel or level of detail along the normal
    float spread;      // edge of a level of detail, metres; else 0
    MaterialRecord material;
    vec3 albedo;
};

SurfacePart partOfGround(ViewParameters view, vec3 position) {
    vec3 start = position + rayOffset(groundVoxel(view), position) * kGroundNormal;
    return SurfacePart(position, kGroundNormal, start, groundVoxel(view), 0.0, groundMaterial(), kGroundAlbedo);
}

SurfacePart partOf(ViewParameters view, Scene scene, SeenPixel seen, Ray ray) {
    SurfacePart part;
    part.position = ray.origin + seen.distance * ray.direction;
    if (isGround(seen)) return partOfGround(view, part.position);
    part.normal = unpackWideNormal(seen.normal);
    part.start = startOfRays(part.position, seen.cell);
    part.cellMetres = metresOfCell(seen.cell);
    part.spread = seen.lodColor != 0u ? part.cellMetres : 0.0;
    part.material = Materials(scene.header.materials).at[seen.material];
    part.albedo = seen.lodColor != 0u ? linearFromSrgb(unpackUnorm4x8(seen.lodColor).rgb) : part.material.albedo;
    return part;
}

SurfacePart partOf(Scene scene, Surface surface) {
    return SurfacePart(surface.position, surface.normal, startOf(surface), surface.voxelMetres, 0.0,
                       materialOf(scene, surface), albedoOf(scene, surface));
}

// The color of one sample, for the screen but for its encoding; `distance` is that of the nearest sample in the end.
void writeColor(ViewParameters view, uint index, vec3 color, float distance) {
    vec4 before = push.sampleIndex == 0u ? vec4(vec3(0.0), kInfinity) : Colors(push.colors).at[index];
    Colors(push.colors).at[index] =
        vec4(before.rgb + color / float(view.samplesPerPixel), min(before.w, distance));
}

// ---- Sums: a group adds up, then to memory ----

shared uint groupCounts[kViewCounterCount];

void beginCounting() {
    if (gl_LocalInvocationIndex < kViewCounterCount) groupCounts[gl_LocalInvocationIndex] = 0u;
    barrier();
}
void count(uint what, uint amount) {
    if (amount != 0u) atomicAdd(groupCounts[what], amount);
}
void count(TraceStatistics statistics) {
    count(kCountSteps, statistics.steps);
    count(kCountStepLimit, statistics.stepLimitReached);
}
void endCounting() {
    barrier();
    if (gl_LocalInvocationIndex >= kViewCounterCount) return;
    uint amount = groupCounts[gl_LocalInvocationIndex];
    if (amount == 0u) return;
    uint before = atomicAdd(Counts(push.counters).at[gl_LocalInvocationIndex].x, amount);
    if (before + amount < before) atomicAdd(Counts(push.counters).at[gl_LocalInvocationIndex].y, 1u);
}

#endif
