// Views that inspect the scene: what the octree and its materials are, without light.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

#include "view_frame.glsl"
#include "view_colours.glsl"

// Hot = one voxel, cold = 64 and more. Dark where the cell is a leaf of the file and no level of detail.
vec3 cellColour(Surface surface) {
    vec3 colour = heatColour(0.8 * (1.0 - float(surface.leafLog2) / 6.0));
    return surface.lodColor != 0u ? colour : 0.3 * colour;
}

vec3 surfaceColour(ViewParameters view, Scene scene, Ray ray, Hit hit) {
    Surface surface = surfaceOf(scene, ray, hit);
    switch (view.mode) {
        case kViewAlbedo: return albedoOf(scene, surface);
        case kViewNormals: return linearFromSrgb(0.5 + 0.5 * surface.normal);
        case kViewMaterial: return linearFromSrgb(indexColour(surface.material));
        case kViewDepth: return heatColour(1.0 - float(octreeLeafLog2(scene, hit)) / 7.0);
        default: return cellColour(surface) * faceShade(surface.normal);
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
        bool struck = hit.instance != kNoInstance;
        count(statistics);
        count(kCountHits, uint(struck));
        vec3 colour = view.mode == kViewSteps    ? heatColour(float(statistics.steps) / view.stepScale)
                      : struck                   ? surfaceColour(view, scene, ray, hit)
                      : view.mode == kViewAlbedo ? toneMap(view.toneMap, view.exposure * skyRadiance(view, ray.direction))
                                                 : kBackground;
        writeColour(view, pixel.index, colour, struck ? hit.t : kInfinity);
    }
    endCounting();
}
