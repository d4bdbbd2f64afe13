// How much of the sun arrives at what each camera ray sees: a hard shadow, tinted by glass.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

#include "view_frame.glsl"

void main() {
    ViewParameters view = Parameters(push.parameters).view;
    Pixel pixel = pixelOf(view);
    beginCounting();
    if (pixel.inside) {
        SeenPixel seen = SeenPixels(push.seen).at[pixel.index];
        vec3 normal = unpackWideNormal(seen.normal);
        if (seen.distance < kInfinity && dot(normal, -view.sunDirection) > 0.0) {
            Ray ray = cameraRay(view, pixel.at);
            vec3 position = ray.origin + seen.distance * ray.direction;
            vec3 origin = startOfRays(position, seen.cell);
            RayCounts counts = RayCounts(0u, TraceStatistics(0u, 0u));
            vec3 fraction = transmittance(Scene(push.scene), Ray(origin, kInfinity, -view.sunDirection, 0.0), counts);
            SeenPixels(push.seen).at[pixel.index].sun = packLight(fraction);
            count(counts.trace);
            count(kCountSunRays, counts.rays);
        }
    }
    endCounting();
}
