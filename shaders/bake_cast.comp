// The rays of one queue: closest hits of paths, or shadow rays whose light arrives where nothing is in between. On
// real devices a launch fills the device once and lanes whose ray has ended take the next one (Aila and Laine 2009,
// "Understanding the Efficiency of Ray Traversal on GPUs"); elsewhere an invocation casts one ray.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

#include "bake_paths.glsl"

layout(constant_id = 1) const uint kQueue = kQueueRays;
layout(constant_id = 2) const uint kPersistent = 0u;
// Persistent: idle lanes that are worth looking for rays, and steps between looks (docs/performance-gpu.md).
const uint kRefill = 10u;
const uint kSteps = 4u;

Ray rayAt(BakeWave wave, uint place) {
    if (kQueue == kQueueRays) {
        uint path = Numbers(wave.rays[push.set]).at[place];
        return Ray(Paths(wave.paths).at[path].origin, kInfinity, Paths(wave.paths).at[path].direction, 0.0);
    }
    ShadowRays rays = ShadowRays(wave.shadowRays[kQueue - kQueueSun]);
    return Ray(rays.at[place].origin, rays.at[place].metres, rays.at[place].direction, 0.0);
}

void lightArrives(BakeWave wave, uint place, vec3 share) {
    ShadowRays rays = ShadowRays(wave.shadowRays[kQueue - kQueueSun]);
    Vectors(wave.arrived).at[rays.at[place].path].rgb += share * rays.at[place].light;
}

void store(BakeWave wave, uint place, Hit hit) {
    if (kQueue == kQueueRays)
        PathHits(wave.hits).at[place] = PathHit(hit.corner, hit.t, hit.instance, hit.node, uint(hit.scale), 0u);
    else if (hit.instance == kNoInstance)
        lightArrives(wave, place, vec3(1.0));
}

uint waitingRays(BakeWave wave) { return Controls(wave.control).control.waiting[push.set * kQueueKinds + kQueue]; }

// --- One ray an invocation ---

void castOne(BakeWave wave, Scene scene, uint place) {
    if (place >= waitingRays(wave)) return;
    RayCounts counts = RayCounts(0u, TraceStatistics(0u, 0u));
    Ray ray = rayAt(wave, place);
    if (kQueue != kQueueRays && kHasGlass != 0u) {
        vec3 share = transmittance(scene, ray, counts);
        if (maxOf(share) > 0.0) lightArrives(wave, place, share);
    } else {
        store(wave, place, traceScene(scene, ray, kQueue != kQueueRays, counts.trace));
    }
    countCapped(wave, counts.trace);
}

// --- Persistent ---

bool enterNext(SceneHeader scene, inout SceneWalk walk) {
    if (kQueue != kQueueRays && walk.hit.instance != kNoInstance) return false;
    return enterNextModel(scene, walk);
}

void castAll(BakeWave wave, SceneHeader scene) {
    Controls controls = Controls(wave.control);
    uint count = waitingRays(wave);
    SceneWalk walk;
    uint place = 0u;
    uint steps = 0u;  // of this walk
    bool hasRay = false;
    bool inModel = false;
    bool more = true;
    for (;;) {
        uint idle = subgroupBallotBitCount(subgroupBallot(!inModel));
        if (idle >= min(kRefill, gl_SubgroupSize)) {
            if (hasRay && !inModel) {
                inModel = enterNext(scene, walk);
                steps = 0u;
                if (!inModel) {
                    store(wave, place, walk.hit);
                    hasRay = false;
                }
            }
            uvec4 freeLanes = subgroupBallot(!hasRay);
            uint freeCount = subgroupBallotBitCount(freeLanes);
            if (more && freeCount != 0u) {
                uint first = 0u;
                if (subgroupElect()) first = atomicAdd(controls.control.taken[kQueue], freeCount);
                first = subgroupBroadcastFirst(first);
                more = first + freeCount < count;
                if (!hasRay) {
                    place = first + subgroupBallotExclusiveBitCount(freeLanes);
                    if (place < count) {
                        walk = beginSceneWalk(scene, rayAt(wave, place));
                        inModel = enterNext(scene, walk);
                        hasRay = inModel;
                        steps = 0u;
                        if (!inModel) store(wave, place, walk.hit);
                    }
                }
            } else if (freeCount == gl_SubgroupSize) {
                return;
            }
        }
        uint state = kWalkGoesOn;
        for (uint i = 0u; i < kSteps && inModel; ++i) {
            state = stepWalk(walk.model);
            inModel = state == kWalkGoesOn;
        }
        steps += kSteps;
        if (inModel && steps >= kMaxTraceSteps) {
            countCapped(wave, TraceStatistics(0u, 1u));
            inModel = false;
        }
        if (state != kWalkGoesOn) leaveModel(walk, state);
        subgroupBarrier();
    }
}

void main() {
    BakeWave wave = Waves(push.wave).at[0];
    Scene scene = Scene(BakeScenes(wave.scene).at[0].scene);
    if (kPersistent != 0u) castAll(wave, scene.header);
    else castOne(wave, scene, invocationIndex());
}
