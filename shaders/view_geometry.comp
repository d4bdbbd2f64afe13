// What each camera ray sees behind all glass, and the first glass in front of it.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

#include "view_frame.glsl"

struct Seen {
    SeenPixel pixel;
    SeenShine shine;
};

// Goes on behind glass until something stops the ray. One body of glass counts once.
Seen look(ViewParameters view, Scene scene, Ray ray, inout RayCounts counts) {
    Seen seen;
    seen.pixel = SeenPixel(kInfinity, 0u, 0u, 0u, 0u, 0u, packLight(vec3(1.0)), 0u);
    seen.shine = SeenShine(vec3(0.0), kInfinity, 0u, 0u, 0u, 0u);
    vec3 camera = ray.origin;
    GlassWalk walk = GlassWalk(ray, vec3(1.0), kNoMaterial);
    for (uint i = 0u; i <= kMaxGlassSteps; ++i) {
        Hit hit = castRay(scene, walk.ray, counts);
        float ground = groundAlong(view, walk.ray);
        if (ground < hit.t) {
            float distance = length(walk.ray.origin + ground * ray.direction - camera);
            seen.pixel = SeenPixel(distance, kGroundMaterial, packWideNormal(kGroundNormal), 0u,
                                   packCell(groundVoxel(view), kGroundNormal), 0u, packLight(walk.through), 0u);
            return seen;
        }
        if (hit.instance == kNoInstance) break;
        Surface surface = surfaceOf(scene, walk.ray, hit);
        float distance = kHasGlass == 0u ? hit.t : length(surface.position - camera);
        bool enters = false;
        Ray before = walk.ray;
        if (i == kMaxGlassSteps || !goOnThroughGlass(scene, walk, hit, surface, materialOf(scene, surface), enters)) {
            seen.pixel = SeenPixel(distance, surface.material, packWideNormal(surface.normal), surface.lodColor,
                                   packCell(surface), 0u, packLight(walk.through), faceWord(view, scene, before, hit));
            return seen;
        }
        if (enters && seen.shine.distance == kInfinity)
            seen.shine = SeenShine(vec3(0.0), distance, surface.material, packWideNormal(surface.normal),
                                   packCell(surface), faceWord(view, scene, before, hit));
    }
    seen.pixel.through = packLight(walk.through);
    return seen;
}

void main() {
    ViewParameters view = Parameters(push.parameters).view;
    Pixel pixel = pixelOf(view);
    beginCounting();
    if (pixel.inside) {
        RayCounts counts = RayCounts(0u, TraceStatistics(0u, 0u));
        Seen seen = look(view, Scene(push.scene), cameraRay(view, pixel.at), counts);
        SeenPixels(push.seen).at[pixel.index] = seen.pixel;
        if ((push.shine.x | push.shine.y) != 0u) SeenShines(push.shine).at[pixel.index] = seen.shine;
        count(counts.trace);
        bool metVoxel = seen.pixel.distance < kInfinity && !isGround(seen.pixel);
        count(kCountHits, uint(metVoxel || seen.shine.distance < kInfinity));
    }
    endCounting();
}
