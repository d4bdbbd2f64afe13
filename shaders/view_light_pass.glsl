// The color of each pixel from what earlier passes found: the including program says where indirect light comes from.
#include "view_lighting.glsl"
#include "view_colors.glsl"

#ifdef PFVOX_VIEW_PROBES
const bool kKnowsLight = true;
#else
const bool kKnowsLight = kHasFaces != 0u;
#endif

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
    vec3 indirect = lightOfWord(seen.ambient);
    if (kKnowsLight && !isGround(seen)) {
        uint tier = seen.ambient == kFaceNoValue ? kTierNone : kTierFaces;
#ifdef PFVOX_VIEW_PROBES
        ProbeLight light = indirectAt(view, part);
        indirect = light.indirect;
        tier = light.tier;
#endif
        count(kCountTiers + tier, 1u);
        count(kCountWithoutValue, uint(tier == kTierNone));
        if (view.mode == kViewIndirect) return toneMap(view.toneMap, view.exposure * indirect);
        if (view.mode == kViewTiers)
            return tier == kTierNone ? vec3(1.0, 0.0, 1.0) : tierColor(tier) * faceShade(part.normal);
    }
    vec3 radiance = radianceFrom(view, part, -ray.direction, unpackLight(seen.sun), indirect);
    if (isGround(seen)) radiance = mix(skyRadiance(view, ray.direction), radiance, groundFraction(view, part.position));
    return finalColor(view, ray, seen, index, radiance);
}

void main() {
    ViewParameters view = Parameters(push.parameters).view;
    Pixel pixel = pixelOf(view);
    if (kKnowsLight) beginCounting();
    if (pixel.inside) {
        SeenPixel seen = SeenPixels(push.seen).at[pixel.index];
        writeColor(view, pixel.index, colorOf(view, cameraRay(view, pixel.at), seen, pixel.index), seen.distance);
    }
    if (kKnowsLight) endCounting();
}
