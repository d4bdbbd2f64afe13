// Views that inspect the scene: what the octree and its materials are, without light.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

#include "view_frame.glsl"
#include "view_colors.glsl"

// Hot = one voxel, cold = 64 and more. Dark where the cell is a leaf of the file and no level of detail.
vec3 cellColor(Surface surface) {
    vec3 color = heatColor(0.8 * (1.0 - float(surface.leafLog2) / 6.0));
    return surface.lodColor != 0u ? color : 0.3 * color;
}

vec3 surfaceColor(ViewParameters view, Scene scene, Ray ray, Hit hit) {
    Surface surface = surfaceOf(scene, ray, hit);
    switch (view.mode) {
        case kViewAlbedo: return albedoOf(scene, surface);
        case kViewNormals: return linearFromSrgb(0.5 + 0.5 * surface.normal);
        case kViewMaterial: return linearFromSrgb(indexColor(surface.material));
        case kViewDepth: return heatColor(1.0 - float(octreeLeafLog2(scene, hit)) / 7.0);
        default: return cellColor(surface) * faceShade(surface.normal);
    }
}

void main() {
    ViewParameters view = Parameters(push.parameters).view;
    Pixel pixel = pixelOf(view);
    beginCounting();
    if (pixel.inside) {
        Scene scene = Scene(push.scene);
        Ray ray = cameraRay(view, pixel.at);
        TraceStatistics statistics = TraceStatistics(0u, 0u);
        Hit hit = traceClosest(scene, ray, statistics);
        bool isHit = hit.instance != kNoInstance;
        count(statistics);
        count(kCountHits, uint(isHit));
        vec3 color = view.mode == kViewSteps    ? heatColor(float(statistics.steps) / view.stepScale)
                      : isHit                   ? surfaceColor(view, scene, ray, hit)
                      : view.mode == kViewAlbedo ? toneMap(view.toneMap, view.exposure * skyRadiance(view, ray.direction))
                                                 : kBackground;
        writeColor(view, pixel.index, color, isHit ? hit.t : kInfinity);
    }
    endCounting();
}
