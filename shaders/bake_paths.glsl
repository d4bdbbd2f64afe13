// Paths of a wave: their random numbers, their rays to emitters, and the queues that rays wait in.
#ifndef PFVOX_BAKE_PATHS_GLSL
#define PFVOX_BAKE_PATHS_GLSL

#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_ballot : require

#include "shared/sampling.glsl.h"
#include "bake_wave.glsl"
#include "emitters.glsl"

// Pairs of random numbers that a vertex has.
const uint kPairDirection = 0u;
const uint kPairEmitterPoint = 1u;
const uint kPairEmitterAndLobe = 2u;  // which emitter, which lobe
const uint kPairGlass = 3u;           // reflected or not, through or not
const uint kPairRoulette = 4u;
const uint kPairsPerVertex = 5u;
// Vertices whose numbers are points of a scrambled Sobol sequence; hashes beyond.
layout(constant_id = 3) const uint kStratifiedVertices = 2u;

vec2 randomPair(uint key, uint vertex, uint pair, uint index) {
    uint pairKey = joinHash(key, vertex * kPairsPerVertex + pair);
    return vertex < kStratifiedVertices ? sobolPair(pairKey, index) : hashPair(pairKey, index);
}

// The ray to one emitter, with its light as the lobes reflect it; light 0 where there is none.
ShadowRay towardsEmitter(BakeScene bake, Lobes lobes, vec3 origin, vec3 normal, vec3 toViewer, float pick, vec2 u) {
    ShadowRay ray = ShadowRay(origin, 0.0, normal, 0u, vec3(0.0), 0.0);
    EmitterSample found = sampleEmitter(bake, origin, pick, u);
    if (maxOf(found.radiance) <= 0.0) return ray;
    Scattering s = evaluateLobes(lobes, normal, toViewer, found.toLight);
    if (maxOf(s.value) <= 0.0) return ray;
    vec3 way = found.end - origin;
    ray.metres = length(way);
    ray.direction = way / ray.metres;
    float weight = bake.sampling == kSampleCombined ? emitterWeight(found.pdf, s.pdf) : 1.0;
    ray.light = found.radiance * s.value * (weight / found.pdf);
    return ray;
}

// --- Queues ---

// A place in a queue for each invocation that wants one: one atomic addition a subgroup.
uint placeInQueue(BakeWave wave, uint set, uint queue, bool wanted) {
    uvec4 all = subgroupBallot(wanted);
    uint first = 0u;
    if (subgroupElect()) {
        uint count = subgroupBallotBitCount(all);
        if (count != 0u) first = atomicAdd(Controls(wave.control).control.waiting[set * kQueueKinds + queue], count);
    }
    return subgroupBroadcastFirst(first) + subgroupBallotExclusiveBitCount(all);
}

void queueRay(BakeWave wave, uint set, bool wanted, uint path) {
    uint place = placeInQueue(wave, set, kQueueRays, wanted);
    if (wanted) Numbers(wave.rays[set]).at[place] = path;
}

// Those whose light is not 0; `queue` is kQueueSun or kQueueEmitters.
void queueShadowRay(BakeWave wave, uint set, uint queue, ShadowRay ray) {
    bool wanted = maxOf(ray.light) > 0.0;
    uint place = placeInQueue(wave, set, queue, wanted);
    if (wanted) ShadowRays(wave.shadowRays[queue - kQueueSun]).at[place] = ray;
}

#endif
