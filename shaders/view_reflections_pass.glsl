// What mirrors and glass add to each pixel: one reflected ray of the surface, one of the first glass in front, and the
// light that such glass scatters. At the end of a ray there is direct sun, indirect light and emission, no further mirror.
// Rough mirrors scatter their rays from frame to frame; the frames' mean is what they show.
#include "view_lighting.glsl"
#include "view_colors.glsl"

const float kMirrorAlpha = 1e-3;  // sharper lobes reflect like mirrors

// `word`: of the face, where there is light on faces.
vec3 indirectOf(ViewParameters view, Scene scene, SurfacePart part, uint word, uint key, inout RayCounts counts) {
    if (kHasFaces != 0u) return lightOfWord(word);
#ifdef PFVOX_VIEW_PROBES
    return indirectAt(view, part).indirect;
#else
    return guessedIndirect(view, scene, part, key, counts);
#endif
}

vec3 groundRadiance(ViewParameters view, Scene scene, Ray ray, float distance, inout RayCounts counts) {
    SurfacePart part = partOfGround(view, ray.origin + distance * ray.direction);
    vec3 indirect = ambientRadiance(view, part.normal);
    vec3 radiance = radianceFrom(view, part, -ray.direction, sunFraction(view, scene, part, counts), indirect);
    return mix(skyRadiance(view, ray.direction), radiance, groundFraction(view, part.position));
}

vec3 radianceAlong(ViewParameters view, Scene scene, Ray ray, uint key, inout RayCounts counts) {
    GlassWalk walk = GlassWalk(ray, vec3(1.0), kNoMaterial);
    for (uint i = 0u; i < kMaxGlassSteps; ++i) {
        Hit hit = castRay(scene, walk.ray, counts);
        float ground = groundAlong(view, walk.ray);
        if (ground < hit.t) return walk.through * groundRadiance(view, scene, walk.ray, ground, counts);
        if (hit.instance == kNoInstance) return walk.through * skyRadiance(view, ray.direction);
        Surface surface = surfaceOf(scene, walk.ray, hit);
        Ray before = walk.ray;
        bool enters;
        if (goOnThroughGlass(scene, walk, hit, surface, materialOf(scene, surface), enters)) continue;
        SurfacePart part = partOf(scene, surface);
        if (part.material.type == kMaterialMetal) part.material.type = 0u;  // what it mirrors is about as bright
        vec3 sun = sunFraction(view, scene, part, counts);
        vec3 indirect = indirectOf(view, scene, part, faceWord(view, scene, before, hit), key, counts);
        return walk.through * radianceFrom(view, part, -ray.direction, sun, indirect);
    }
    return vec3(0.0);
}

// The lobe's own direction for this pixel and frame, and how much of what comes from there is reflected.
vec3 mirrored(Lobes lobes, float roughness, vec3 normal, vec3 toViewer, vec2 u, out vec3 weight) {
    float alpha = roughness * roughness;
    vec3 half_ = normal;
    if (alpha > kMirrorAlpha) {
        vec3 tangent, bitangent;
        frameAbout(normal, tangent, bitangent);
        vec3 local = vec3(dot(toViewer, tangent), dot(toViewer, bitangent), dot(toViewer, normal));
        vec3 m = visibleNormal(local, alpha, u);
        half_ = m.x * tangent + m.y * bitangent + m.z * normal;
    }
    vec3 direction = reflect(-toViewer, half_);
    float cosine = dot(direction, normal);
    vec3 fresnel = mix(lobes.specular0, vec3(1.0), schlickWeight(dot(toViewer, half_)));
    float shadow = alpha > kMirrorAlpha ? ggxShadow(max(cosine, 0.0), alpha) : 1.0;
    weight = cosine > 0.0 ? lobes.specular * fresnel * shadow : vec3(0.0);
    return direction;
}

vec2 pixelNoise(ViewParameters view, uvec2 pixel) {
    uint seed = hash(pixel.x + (pixel.y << 16));
    vec2 start = vec2(seed & 0xffffu, seed >> 16) / 65536.0;
    return fract(start + float(sampleNumber(view)) * vec2(0.7548776662, 0.5698402910));
}

vec3 surfaceShine(ViewParameters view, Scene scene, Ray ray, SeenPixel seen, uvec2 pixel, inout RayCounts counts) {
    SurfacePart part = partOf(view, scene, seen, ray);
    Lobes lobes = lobesOf(part.material, part.albedo, part.normal, -ray.direction);
    if (lobes.specular <= 0.0) return vec3(0.0);
    vec3 weight;
    vec3 direction = mirrored(lobes, part.material.roughness, part.normal, -ray.direction, pixelNoise(view, pixel), weight);
    if (maxOf(weight) < 1e-3) return vec3(0.0);
    Ray away = Ray(part.start, kInfinity, direction, 0.0);
    return unpackLight(seen.through) * weight * radianceAlong(view, scene, away, joinHash(pixelKey(pixel), 3u), counts);
}

vec3 glassShine(ViewParameters view, Scene scene, Ray ray, SeenShine shine, uvec2 pixel, inout RayCounts counts) {
    SeenPixel glass = SeenPixel(shine.distance, shine.material, shine.normal, 0u, shine.cell, 0u, 0u, 0u);
    SurfacePart part = partOf(view, scene, glass, ray);
    float reflectance = glassReflectance(part.material, abs(dot(part.normal, ray.direction)));
    vec3 radiance = vec3(0.0);
    if (reflectance > 1e-3) {
        Ray away = Ray(part.start, kInfinity, reflect(ray.direction, part.normal), 0.0);
        radiance += reflectance * radianceAlong(view, scene, away, joinHash(pixelKey(pixel), 4u), counts);
    }
    if (part.material.transparency < 1.0) {
        vec3 sun = sunFraction(view, scene, part, counts);
        vec3 indirect = indirectOf(view, scene, part, shine.ambient, joinHash(pixelKey(pixel), 5u), counts);
        radiance += (1.0 - reflectance) * radianceFrom(view, part, -ray.direction, sun, indirect);
    }
    return radiance;
}

void main() {
    ViewParameters view = Parameters(push.parameters).view;
    Pixel pixel = pixelOf(view);
    beginCounting();
    if (pixel.inside) {
        Scene scene = Scene(push.scene);
        Ray ray = cameraRay(view, pixel.at);
        SeenPixel seen = SeenPixels(push.seen).at[pixel.index];
        SeenShine shine = SeenShines(push.shine).at[pixel.index];
        RayCounts counts = RayCounts(0u, TraceStatistics(0u, 0u));
        vec3 added = vec3(0.0);
        if (seen.distance < kInfinity)
            added += surfaceShine(view, scene, ray, seen, pixel.at, counts);
        if (kHasGlass != 0u && shine.distance < kInfinity) added += glassShine(view, scene, ray, shine, pixel.at, counts);
        SeenShines(push.shine).at[pixel.index].added = added;
        count(counts.trace);
        count(kCountReflectionRays, counts.rays);
    }
    endCounting();
}
