// Guesses the indirect light of what each camera ray sees: of everything without probes, with them of the ground alone.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

#include "view_frame.glsl"
#include "view_ambient.glsl"

void main() {
    ViewParameters view = Parameters(push.parameters).view;
    Pixel pixel = pixelOf(view);
    beginCounting();
    if (pixel.inside) {
        SeenPixel seen = SeenPixels(push.seen).at[pixel.index];
        bool isKnown = kHasFaces != 0u || (view.field.x | view.field.y) != 0u;
        if (seen.distance < kInfinity && (!isKnown || isGround(seen))) {
            Scene scene = Scene(push.scene);
            SurfacePart part = partOf(view, scene, seen, cameraRay(view, pixel.at));
            RayCounts counts = RayCounts(0u, TraceStatistics(0u, 0u));
            vec3 indirect = guessedIndirect(view, scene, part, pixelKey(pixel.at), counts);
            SeenPixels(push.seen).at[pixel.index].ambient = packRgb9e5(indirect);
            count(counts.trace);
            count(kCountAmbientRays, counts.rays);
        }
    }
    endCounting();
}
