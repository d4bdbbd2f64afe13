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
    vec3 through = vec3(1.0);
    uint lastGlass = kNoMaterial;
    for (uint i = 0u; i <= kMaxGlassSteps; ++i) {
        Hit hit = castRay(scene, ray, counts);
        float ground = groundAlong(view, ray);
        if (ground < hit.t) {
            float distance = length(ray.origin + ground * ray.direction - camera);
            seen.pixel = SeenPixel(distance, kGroundMaterial, packWideNormal(kGroundNormal), 0u,
                                   packCell(groundVoxel(view), kGroundNormal), 0u, packLight(through), 0u);
            return seen;
        }
        if (hit.instance == kNoInstance) break;
        Surface surface = surfaceOf(scene, ray, hit);
        MaterialRecord material = materialOf(scene, surface);
        float distance = kHasGlass == 0u ? hit.t : length(surface.position - camera);
        if (kHasGlass == 0u || !letsThrough(material) || i == kMaxGlassSteps) {
            seen.pixel = SeenPixel(distance, surface.material, packWideNormal(surface.normal), surface.lodColor,
                                   packCell(surface), 0u, packLight(through), 0u);
            return seen;
        }
        if (entersGlass(surface, lastGlass)) {
            if (seen.shine.distance == kInfinity)
                seen.shine = SeenShine(vec3(0.0), distance, surface.material, packWideNormal(surface.normal),
                                       packCell(surface), 0u);
            float cosine = abs(dot(surface.normal, ray.direction));
            through *= (1.0 - glassReflectance(material, cosine)) * glassTint(material);
        }
        lastGlass = surface.material;
        ray = behindGlass(scene, ray, hit, surface);
    }
    seen.pixel.through = packLight(through);
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
