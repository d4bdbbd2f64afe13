// The color of each pixel from what earlier passes found: the including program says where indirect light comes from.
#include "view_lighting.glsl"
#include "view_colors.glsl"

vec3 finalColor(ViewParameters view, Ray ray, SeenPixel seen, uint index, vec3 radiance) {
    radiance *= unpackLight(seen.through);
    if ((push.shine.x | push.shine.y) != 0u) radiance += SeenShines(push.shine).at[index].added;
    return toneMap(view.toneMap, view.exposure * radiance);
}

vec3 colorOf(ViewParameters view, Ray ray, SeenPixel seen, uint index) {
    if (seen.distance == kInfinity) {
        if (view.mode != kViewFinal) return kBackground;
        return finalColor(view, ray, seen, index, skyRadiance(view, ray.direction));
    }
    SurfacePart part = partOf(view, Scene(push.scene), seen, ray);
    vec3 indirect = unpackLight(seen.ambient);
#ifdef PFVOX_VIEW_PROBES
    if (!isGround(seen)) {
        ProbeLight light = indirectAt(view, part);
        count(kCountTiers + light.tier, 1u);
        count(kCountWithoutValue, uint(light.tier == kTierNone));
        if (view.mode == kViewIndirect) return toneMap(view.toneMap, view.exposure * light.indirect);
        if (view.mode == kViewTiers)
            return light.tier == kTierNone ? vec3(1.0, 0.0, 1.0) : tierColor(light.tier) * faceShade(part.normal);
        indirect = light.indirect;
    }
#endif
    vec3 radiance = radianceFrom(view, part, -ray.direction, unpackLight(seen.sun), indirect);
    if (isGround(seen)) radiance = mix(skyRadiance(view, ray.direction), radiance, groundFraction(view, part.position));
    return finalColor(view, ray, seen, index, radiance);
}

void main() {
    ViewParameters view = Parameters(push.parameters).view;
    Pixel pixel = pixelOf(view);
#ifdef PFVOX_VIEW_PROBES
    beginCounting();
#endif
    if (pixel.inside) {
        SeenPixel seen = SeenPixels(push.seen).at[pixel.index];
        writeColor(view, pixel.index, colorOf(view, cameraRay(view, pixel.at), seen, pixel.index), seen.distance);
    }
#ifdef PFVOX_VIEW_PROBES
    endCounting();
#endif
}
