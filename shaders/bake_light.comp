// Indirect light at the surfaces that a probe sees: paths from each texel's surface point, up to 16 of one
// texel an invocation, summed in their order. A workgroup is one tile and one batch of samples.
//
// The estimate of I = E / pi is the mean over cosine-distributed directions of the radiance that comes in. Light at a
// vertex is looked for twice, by a ray to an emitter and by the scattered direction, weighted by the balance heuristic.
// The sun counts from the second vertex on. A lane whose path has ended begins its next one at once.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

#include "shared/bake.glsl.h"
#include "shared/probe_maths.glsl.h"
#include "shared/sampling.glsl.h"
#define PFVOX_TRACE_GROUP_SIZE kBakeGroupSize
#include "bake_rays.glsl"

layout(local_size_x = kBakeGroupSize) in;
// Of a batch: fewer where a driver bounds the loops of an invocation (docs/decisions/013-baker.md).
layout(constant_id = 1) const uint kSamplesPerRun = kBatchSamples;

layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer SeenTexels { SeenTexel at[]; };
layout(buffer_reference, std430, buffer_reference_align = 8) readonly buffer Items { uvec2 at[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) writeonly buffer Sums { vec4 at[]; };
layout(push_constant) uniform Push { LightPush push; };

// Pairs of random numbers that a vertex has.
const uint kPairDirection = 0u;
const uint kPairEmitterPoint = 1u;
const uint kPairEmitterAndLobe = 2u;  // which emitter, which lobe
const uint kPairGlass = 3u;           // reflected or not, through or not
const uint kPairRoulette = 4u;
const uint kPairsPerVertex = 5u;
const uint kStratifiedVertices = 2u;
const float kMaxSurvival = 0.95;

struct Path {
    Ray ray;
    vec3 throughput;
    float density;    // of the ray's direction, per steradian; < 0: no emitter sampling could have found it
    float travelled;  // metres since the last vertex that scattered
    uint bounces;     // vertices behind the texel's
    uint lastGlass;   // the body that the ray is in
    uint glassSteps;
    uint sampleIndex;
};

vec2 randomPair(uint key, uint vertex, uint pair, uint index) {
    uint pairKey = joinHash(key, vertex * kPairsPerVertex + pair);
    return vertex < kStratifiedVertices ? sobolPair(pairKey, index) : hashPair(pairKey, index);
}

// --- Emitters ---

float emitterWeight(float density, float otherDensity) { return density / (density + otherDensity); }

EmitterFace pickEmitter(BakeScene bake, float u) {
    float scaled = u * float(bake.emitterCount);
    uint slot = min(uint(scaled), bake.emitterCount - 1u);
    EmitterFace face = Emitters(bake.emitters).at[slot];
    if (scaled - float(slot) < face.threshold) return face;
    return Emitters(bake.emitters).at[face.alias];
}

// Where light is looked for: `toLight` unit, `radiance` 0 where nothing comes.
struct EmitterSample {
    vec3 toLight;
    float density;  // per steradian
    vec3 radiance;
    vec3 end;       // of the shadow ray
};

EmitterSample sampleEmitter(BakeScene bake, vec3 origin, float pick, vec2 u) {
    EmitterFace face = pickEmitter(bake, pick);
    vec3 outward = cross(face.edgeU, face.edgeV);
    float area = length(outward);
    outward /= area;
    vec3 point = face.corner + u.x * face.edgeU + u.y * face.edgeV;
    vec3 away = point - origin;
    float squared = dot(away, away);
    EmitterSample found;
    found.toLight = away * inversesqrt(max(squared, 1e-30));
    float cosine = -dot(outward, found.toLight);
    found.radiance = cosine > 0.0 && squared > 0.0 ? face.radiance : vec3(0.0);
    found.density = meanOf(face.radiance) / bake.emitterPower * squared / max(cosine, 1e-12);
    found.end = point + face.offset * outward;
    return found;
}

// Density with which sampleEmitter finds the emitter that a path has run into.
float densityOfEmitter(BakeScene bake, vec3 emission, float metres, float cosine) {
    return meanOf(emission) / bake.emitterPower * metres * metres / max(cosine, 1e-12);
}

// Light from one emitter, reflected by the lobes.
vec3 emittersAt(BakeScene bake, Lobes lobes, vec3 origin, vec3 normal, vec3 toViewer, float pick, vec2 u,
                inout RayCounts counts) {
    EmitterSample found = sampleEmitter(bake, origin, pick, u);
    if (maxOf(found.radiance) <= 0.0) return vec3(0.0);
    Scattering s = evaluateLobes(lobes, normal, toViewer, found.toLight);
    if (maxOf(s.value) <= 0.0) return vec3(0.0);
    vec3 way = found.end - origin;
    float metres = length(way);
    vec3 through = transmittance(Scene(bake.scene), Ray(origin, metres, way / metres, 0.0), counts);
    float weight = bake.sampling == kSampleCombined ? emitterWeight(found.density, s.density) : 1.0;
    return through * found.radiance * s.value * (weight / found.density);
}

bool looksForEmitters(BakeScene bake) { return bake.emitterCount != 0u && bake.sampling != kSampleDirections; }

// --- Paths ---

// The texels of the depth map under one of the light map, bit i + 4j; those that see a surface.
uint surfacesUnder(uvec2 texel, uint block) {
    uint mask = 0u;
    for (uint j = 0u; j < block; ++j) {
        for (uint i = 0u; i < block; ++i) {
            uint index = texel.x * block + i + push.depthEdge * (texel.y * block + j);
            if (SeenTexels(push.texels).at[index].metres >= 0.0) mask |= 1u << (i + 4u * j);
        }
    }
    return mask;
}

uint bitOfRank(uint mask, uint rank) {
    for (uint i = 0u; i < rank; ++i) mask &= mask - 1u;
    return uint(findLSB(mask));
}

// Samples go round the surfaces under the texel.
Path beginPath(BakeScene bake, uvec2 texel, uint mask, uint key, uint index, inout vec3 total, inout RayCounts counts) {
    uint block = push.depthEdge / push.lightEdge;
    uint bit = bitOfRank(mask, index % uint(bitCount(mask)));
    uvec2 at = texel * block + uvec2(bit & 3u, bit >> 2);
    SeenTexel seen = SeenTexels(push.texels).at[at.x + push.depthEdge * at.y];
    vec3 position = push.probe + seen.metres * directionOfTexel(at.x, at.y, push.depthEdge);
    vec3 origin = position + seen.offset * seen.normal;
    if (looksForEmitters(bake)) {
        Lobes white = Lobes(vec3(1.0), vec3(0.0), 0.0, 1.0, 0.0);
        float pick = randomPair(key, 0u, kPairEmitterAndLobe, index).x;
        vec2 u = randomPair(key, 0u, kPairEmitterPoint, index);
        total += emittersAt(bake, white, origin, seen.normal, seen.normal, pick, u, counts);
    }
    vec3 local = cosineDirection(randomPair(key, 0u, kPairDirection, index));
    Ray ray = Ray(origin, kInfinity, inFrame(local, seen.normal), 0.0);
    return Path(ray, vec3(1.0), local.z / kPi, 0.0, 0u, kNoMaterial, 0u, index);
}

vec3 emissionSeen(BakeScene bake, Path path, vec3 emission, float cosine) {
    if (path.density < 0.0 || !looksForEmitters(bake)) return path.throughput * emission;
    if (bake.sampling == kSampleEmitters) return vec3(0.0);
    float other = densityOfEmitter(bake, emission, path.travelled, cosine);
    return path.throughput * emission * emitterWeight(path.density, other);
}

// True when the ray is reflected by glass or goes on through it; false when it meets the glass's Lambert share.
bool passGlass(Scene scene, inout Path path, Hit hit, Surface surface, MaterialRecord material, vec2 u) {
    bool enters = entersGlass(surface, path.lastGlass);
    path.lastGlass = surface.material;
    if (enters) {
        float reflectance = glassReflectance(material, abs(dot(surface.normal, path.ray.direction)));
        if (u.x < reflectance) {
            vec3 origin = surface.position + rayOffset(surface) * surface.normal;
            path.ray = Ray(origin, kInfinity, reflect(path.ray.direction, surface.normal), 0.0);
            path.density = -1.0;
            path.lastGlass = kNoMaterial;
            return true;
        }
        float through = material.transparency;
        if (u.y >= through) {
            path.throughput /= max(1.0 - through, 1e-6);  // lobesOf has the share again
            return false;
        }
        path.throughput *= material.albedo;
    }
    vec3 before = path.ray.origin;
    path.ray = behindGlass(scene, path.ray, hit, surface);
    path.ray.tMax = kInfinity;
    path.travelled += distance(path.ray.origin, before);
    return true;
}

// One ray further. False when the path has ended.
bool extendPath(BakeScene bake, inout Path path, uint key, inout vec3 total, inout RayCounts counts) {
    Scene scene = Scene(bake.scene);
    Hit hit = castRay(scene, path.ray, counts);
    if (hit.instance == kNoInstance) {
        total += path.throughput * skyRadiance(bake, path.ray.direction);
        return false;
    }
    Surface surface = surfaceOf(scene, path.ray, hit);
    MaterialRecord material = materialOf(scene, surface);
    vec3 toViewer = -path.ray.direction;
    uint vertex = path.bounces + 1u;
    if (kHasGlass != 0u && letsThrough(material)) {
        if (++path.glassSteps > kMaxGlassSteps) return false;
        vec2 u = randomPair(joinHash(key, path.glassSteps), vertex, kPairGlass, path.sampleIndex);
        if (passGlass(scene, path, hit, surface, material, u)) return true;
    }
    path.travelled += hit.t;
    if (material.emissionStrength > 0.0)
        total += emissionSeen(bake, path, emissionOf(material), dot(surface.normal, toViewer));
    if (path.bounces >= bake.maxBounces) return false;
    ++path.bounces;

    vec3 origin = surface.position + rayOffset(surface) * surface.normal;
    Lobes lobes = lobesOf(material, albedoOf(scene, surface), surface.normal, toViewer);
    if (hasSun(bake, surface.normal)) {
        vec3 value = evaluateLobes(lobes, surface.normal, toViewer, -bake.sunDirection).value;
        total += path.throughput * value * sunAt(bake, origin, counts);
    }
    vec2 emitterAndLobe = randomPair(key, vertex, kPairEmitterAndLobe, path.sampleIndex);
    if (looksForEmitters(bake)) {
        vec2 u = randomPair(key, vertex, kPairEmitterPoint, path.sampleIndex);
        total += path.throughput *
                 emittersAt(bake, lobes, origin, surface.normal, toViewer, emitterAndLobe.x, u, counts);
    }
    vec2 u = randomPair(key, vertex, kPairDirection, path.sampleIndex);
    vec3 direction = sampleLobes(lobes, surface.normal, toViewer, u, emitterAndLobe.y);
    Scattering s = evaluateLobes(lobes, surface.normal, toViewer, direction);
    if (maxOf(s.value) <= 0.0) return false;
    vec3 weight = s.value / s.density;
    if (path.bounces >= kRouletteBounce) {
        float survival = min(maxOf(weight), kMaxSurvival);
        if (randomPair(key, vertex, kPairRoulette, path.sampleIndex).x >= survival) return false;
        weight /= survival;
    }
    path.throughput *= weight;
    path.ray = Ray(origin, kInfinity, direction, 0.0);
    path.density = s.density;
    path.travelled = 0.0;
    path.lastGlass = kNoMaterial;
    return true;
}

void main() {
    uint group = gl_WorkGroupID.x;
    uvec2 item = Items(push.items).at[group];
    uint tilesPerRow = push.lightEdge / kTileEdge;
    uint lane = gl_LocalInvocationIndex;
    uvec2 texel = uvec2(item.x % tilesPerRow, item.x / tilesPerRow) * kTileEdge + uvec2(lane % kTileEdge, lane / kTileEdge);
    BakeScene bake = BakeScenes(push.scene).at[0];
    uint mask = surfacesUnder(texel, push.depthEdge / push.lightEdge);
    uint key = texelKey(bake.seedLow, bake.seedHigh, push.probeIndex, texel.x + push.lightEdge * texel.y);

    RayCounts counts = RayCounts(0u, TraceStatistics(0u, 0u));
    vec3 total = vec3(0.0);
    uint next = item.y;
    uint end = mask == 0u ? next : next + kSamplesPerRun;
    bool alive = false;
    Path path;
    for (;;) {
        if (!alive) {
            if (next == end) break;
            path = beginPath(bake, texel, mask, key, next++, total, counts);
        }
        alive = extendPath(bake, path, key, total, counts);
    }
    Sums(push.sums).at[group * kTileTexels + lane] = vec4(total, uintBitsToFloat(counts.rays));
    if (counts.trace.capped != 0u) atomicAdd(Counters(push.counters).at[0].cappedRays, counts.trace.capped);
}
