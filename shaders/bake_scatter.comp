// One vertex of each path whose ray has been cast: emission and sky that the ray has found, shadow rays to the sun and
// to an emitter, and the next ray. Light at a vertex is looked for twice, by a ray to an emitter and by the scattered
// direction, weighted by the balance heuristic.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

#include "bake_paths.glsl"

const float kMaxSurvival = 0.95;
const uint kGlassStep = 1u << 16;

// What a vertex sends out.
struct Vertex {
    vec3 arrived;  // light that the ray has brought
    ShadowRay sun;
    ShadowRay emitter;
};

Ray rayOf(PathState path) { return Ray(path.origin, kInfinity, path.direction, 0.0); }
uint bouncesOf(PathState path) { return path.steps & (kGlassStep - 1u); }

vec3 emissionSeen(BakeScene bake, PathState path, vec3 emission, float cosine) {
    if (path.pdf < 0.0 || !looksForEmitters(bake)) return path.throughput * emission;
    if (bake.sampling == kSampleEmitters) return vec3(0.0);
    float other = emitterPdf(bake, emission, path.travelled, cosine);
    return path.throughput * emission * emitterWeight(path.pdf, other);
}

// True when the ray is reflected by glass or goes on through it; false when it meets the glass's Lambert fraction.
bool passGlass(Scene scene, inout PathState path, Hit hit, Surface surface, MaterialRecord material, vec2 u) {
    bool enters = entersGlass(surface, path.lastGlass);
    path.lastGlass = surface.material;
    if (enters) {
        float reflectance = glassReflectance(material, abs(dot(surface.normal, path.direction)));
        if (u.x < reflectance) {
            path.origin = startOf(surface);
            path.direction = reflect(path.direction, surface.normal);
            path.pdf = -1.0;
            path.lastGlass = kNoMaterial;
            return true;
        }
        float through = material.transparency;
        if (u.y >= through) {
            path.throughput /= max(1.0 - through, 1e-6);  // lobesOf has the fraction again
            return false;
        }
        path.throughput *= material.albedo;
    }
    vec3 before = path.origin;
    path.origin = behindGlass(scene, rayOf(path), hit, surface).origin;
    path.travelled += distance(path.origin, before);
    return true;
}

// One vertex further. False when the path has ended.
bool extendPath(BakeScene bake, inout PathState path, Hit hit, inout Vertex found) {
    Scene scene = Scene(bake.scene);
    if (hit.instance == kNoInstance) {
        found.arrived = path.throughput * skyRadiance(bake, path.direction);
        return false;
    }
    Surface surface = surfaceOf(scene, rayOf(path), hit);
    MaterialRecord material = materialOf(scene, surface);
    vec3 toViewer = -path.direction;
    uint bounces = bouncesOf(path);
    uint vertex = bounces + 1u;
    if (kHasGlass != 0u && letsThrough(material)) {
        path.steps += kGlassStep;
        uint glassSteps = path.steps / kGlassStep;
        if (glassSteps > kMaxGlassSteps) return false;
        vec2 u = randomPair(joinHash(path.key, glassSteps), vertex, kPairGlass, path.sampleIndex);
        if (passGlass(scene, path, hit, surface, material, u)) return true;
    }
    path.travelled += hit.t;
    if (material.emissionStrength > 0.0)
        found.arrived = emissionSeen(bake, path, emissionOf(material), dot(surface.normal, toViewer));
    if (bounces >= bake.maxBounces) return false;
    ++path.steps;

    vec3 origin = startOf(surface);
    Lobes lobes = lobesOf(material, albedoOf(scene, surface), surface.normal, toViewer);
    if (hasSun(bake, surface.normal)) {
        vec3 value = evaluateLobes(lobes, surface.normal, toViewer, -bake.sunDirection).value;
        found.sun.origin = origin;
        found.sun.metres = kInfinity;
        found.sun.direction = -bake.sunDirection;
        found.sun.light = path.throughput * value * bake.sunIrradiance;
    }
    vec2 emitterAndLobe = randomPair(path.key, vertex, kPairEmitterAndLobe, path.sampleIndex);
    if (looksForEmitters(bake)) {
        vec2 u = randomPair(path.key, vertex, kPairEmitterPoint, path.sampleIndex);
        found.emitter = towardsEmitter(bake, lobes, origin, surface.normal, toViewer, emitterAndLobe.x, u);
        found.emitter.light *= path.throughput;
    }
    vec2 u = randomPair(path.key, vertex, kPairDirection, path.sampleIndex);
    vec3 direction = sampleLobes(lobes, surface.normal, toViewer, u, emitterAndLobe.y);
    Scattering s = evaluateLobes(lobes, surface.normal, toViewer, direction);
    if (maxOf(s.value) <= 0.0) return false;
    vec3 weight = s.value / s.pdf;
    if (bounces + 1u >= kRouletteBounce) {
        float survival = min(maxOf(weight), kMaxSurvival);
        if (randomPair(path.key, vertex, kPairRoulette, path.sampleIndex).x >= survival) return false;
        weight /= survival;
    }
    path.throughput *= weight;
    path.origin = origin;
    path.direction = direction;
    path.pdf = s.pdf;
    path.travelled = 0.0;
    path.lastGlass = kNoMaterial;
    return true;
}

void main() {
    BakeWave wave = Waves(push.wave).at[0];
    BakeScene bake = BakeScenes(wave.scene).at[0];
    uint place = invocationIndex();
    uint index = 0u;
    bool alive = false;
    ShadowRay none = ShadowRay(vec3(0.0), 0.0, vec3(0.0), 0u, vec3(0.0), 0.0);
    Vertex found = Vertex(vec3(0.0), none, none);
    if (place < Controls(wave.control).control.waiting[push.set * kQueueKinds + kQueueRays]) {
        index = Numbers(wave.rays[push.set]).at[place];
        PathState path = Paths(wave.paths).at[index];
        PathHit stored = PathHits(wave.hits).at[place];
        Hit hit = Hit(stored.t, stored.instance, stored.node, int(stored.scale), stored.corner, stored.axis);
        alive = extendPath(bake, path, hit, found);
        if (alive) Paths(wave.paths).at[index] = path;
        if (maxOf(found.arrived) > 0.0) Vectors(wave.arrived).at[index].rgb += found.arrived;
        found.sun.path = index;
        found.emitter.path = index;
    }
    uint next = 1u - push.set;
    queueRay(wave, next, alive, index);
    queueShadowRay(wave, next, kQueueSun, found.sun);
    queueShadowRay(wave, next, kQueueEmitters, found.emitter);
}
