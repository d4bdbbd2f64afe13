// Paths of the reference that probes are held against (libbake/src/verify).
//
// Rays, materials and the list of emitters are the baker's; the loop, its weights and its numbers are not. Light is what a path
// runs into, the sun from the second vertex on, and at each vertex one sample of the emitters, joined with the first by the
// balance heuristic. First directions of even and of odd samples are two sequences that know nothing of each other: how far
// their means are apart tells the noise. The includer defines PFVOX_TRACE_GROUP_SIZE.
#ifndef PFVOX_REFERENCE_PATH_GLSL
#define PFVOX_REFERENCE_PATH_GLSL

#include "emitters.glsl"

const uint kMaxReferenceSteps = 256u;

// ---- Numbers ----

uint randomState;

float random() {  // PCG
    randomState = randomState * 747796405u + 2891336453u;
    uint word = (randomState >> ((randomState >> 28) + 4u) ^ randomState) * 277803737u;
    return float((word >> 22 ^ word) >> 8) / 16777216.0;
}

void seedRandom(uint pixel, uint index) {
    randomState = pixel * 0x9e3779b9u ^ (index + 1u) * 0x85ebca6bu;
    for (int i = 0; i < 3; ++i) random();
}

// First directions fill the square evenly (the additive recurrence of the plastic number), from a start by chance.
vec2 firstPair(uint pixel, uint number) {
    randomState = pixel * 0x85ebca6bu ^ ((number & 1u) + 1u) * 0xc2b2ae35u;
    for (int i = 0; i < 3; ++i) random();
    vec2 start = vec2(random(), random());
    uint step = number >> 1;
    // Products in 32 bits of fraction, which wrap around as they should.
    uvec2 walked = uvec2(step * 3242174889u, step * 2447445414u);
    return fract(start + vec2(walked >> 8) / 16777216.0);
}

// ---- Paths ----

struct ReferencePath {
    Ray ray;
    vec3 throughput;
    float pdf;    // of the ray's direction, per steradian; < 0: no emitter sample could have found it
    float travelled;  // metres behind the last vertex that scattered, through glass
    uint lastGlass;   // the body that the ray is in
};

// True when glass lets the path go on in a straight line or reflects it; false at its Lambert fraction.
bool referenceGlass(Scene scene, inout ReferencePath path, Hit hit, Surface surface, MaterialRecord material) {
    bool enters = entersGlass(surface, path.lastGlass);
    path.lastGlass = surface.material;
    if (enters) {
        if (random() < glassReflectance(material, abs(dot(surface.normal, path.ray.direction)))) {
            path.ray = Ray(startOf(surface), kInfinity, reflect(path.ray.direction, surface.normal), 0.0);
            path.pdf = -1.0;
            path.lastGlass = kNoMaterial;
            return true;
        }
        if (random() >= material.transparency) {
            path.throughput /= max(1.0 - material.transparency, 1e-6);  // lobesOf has the fraction again
            return false;
        }
        path.throughput *= material.albedo;
    }
    vec3 before = path.ray.origin;
    path.ray = behindGlass(scene, path.ray, hit, surface);
    path.ray.tMax = kInfinity;
    path.travelled += distance(before, path.ray.origin);
    return true;
}

// Light of one emitter at a vertex, as its lobes reflect it.
vec3 emitterAt(BakeScene bake, Lobes lobes, vec3 origin, vec3 normal, vec3 toViewer, inout RayCounts counts) {
    if (!looksForEmitters(bake)) return vec3(0.0);
    float pick = random();
    EmitterSample found = sampleEmitter(bake, origin, pick, vec2(random(), random()));
    if (maxOf(found.radiance) <= 0.0) return vec3(0.0);
    Scattering s = evaluateLobes(lobes, normal, toViewer, found.toLight);
    if (maxOf(s.value) <= 0.0) return vec3(0.0);
    vec3 way = found.end - origin;
    float metres = length(way);
    vec3 fraction = transmittance(Scene(bake.scene), Ray(origin, metres, way / metres, 0.0), counts);
    return fraction * found.radiance * s.value / (found.pdf + s.pdf);
}

// Fraction of the emission that a path has run into which is not left to emitterAt.
float fractionOfDirection(BakeScene bake, ReferencePath path, vec3 emission, float cosine) {
    if (path.pdf < 0.0 || !looksForEmitters(bake)) return 1.0;
    return emitterWeight(path.pdf, emitterPdf(bake, emission, path.travelled, cosine));
}

// I at a point of a surface, `origin` a little off it; `first` picks the first direction.
vec3 referenceLight(BakeScene bake, vec3 origin, vec3 normal, vec2 first) {
    Scene scene = Scene(bake.scene);
    RayCounts counts = RayCounts(0u, TraceStatistics(0u, 0u));
    Lobes white = Lobes(vec3(1.0), vec3(0.0), 0.0, 1.0, 0.0);
    vec3 local = cosineDirection(first);
    ReferencePath path = ReferencePath(Ray(origin, kInfinity, inFrame(local, normal), 0.0), vec3(1.0), local.z / kPi, 0.0,
                                       kNoMaterial);
    vec3 total = emitterAt(bake, white, origin, normal, normal, counts);
    uint bounces = 0u;
    for (uint step = 0u; step < kMaxReferenceSteps; ++step) {
        Hit hit = castRay(scene, path.ray, counts);
        if (hit.instance == kNoInstance) return total + path.throughput * skyRadiance(bake, path.ray.direction);
        Surface surface = surfaceOf(scene, path.ray, hit);
        MaterialRecord material = materialOf(scene, surface);
        if (letsThrough(material) && referenceGlass(scene, path, hit, surface, material)) continue;
        path.travelled += hit.t;
        vec3 toViewer = -path.ray.direction;
        vec3 emission = emissionOf(material);
        if (maxOf(emission) > 0.0)
            total += path.throughput * emission * fractionOfDirection(bake, path, emission, dot(surface.normal, toViewer));
        if (bounces++ >= bake.maxBounces) return total;
        vec3 from = startOf(surface);
        Lobes lobes = lobesOf(material, albedoOf(scene, surface), surface.normal, toViewer);
        if (hasSun(bake, surface.normal))
            total += path.throughput * evaluateLobes(lobes, surface.normal, toViewer, -bake.sunDirection).value *
                     sunAt(bake, from, counts);
        total += path.throughput * emitterAt(bake, lobes, from, surface.normal, toViewer, counts);
        vec3 direction = sampleLobes(lobes, surface.normal, toViewer, vec2(random(), random()), random());
        Scattering s = evaluateLobes(lobes, surface.normal, toViewer, direction);
        if (maxOf(s.value) <= 0.0) return total;
        path.throughput *= s.value / s.pdf;
        if (bounces >= kRouletteBounce) {
            float survival = min(maxOf(path.throughput), 0.95);
            if (random() >= survival) return total;
            path.throughput /= survival;
        }
        path = ReferencePath(Ray(from, kInfinity, direction, 0.0), path.throughput, s.pdf, 0.0, kNoMaterial);
    }
    return total;
}

#endif
