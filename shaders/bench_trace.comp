// Rays of one kind through a scene, for bench_trace: as a viewer and a baker cast them, with nothing else around.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_ballot : require

#include "shared/bench.glsl.h"
#define PFVOX_TRACE_GROUP_SIZE kBenchGroupSize
#include "octree_trace.glsl"

layout(constant_id = 0) const uint kKind = kBenchPrimary;
layout(constant_id = 1) const uint kPath = kBenchGeometry;
layout(constant_id = 2) const uint kPersistent = 0u;
layout(constant_id = 3) const uint kCount = 0u;

layout(local_size_x = kBenchGroupSize) in;

layout(buffer_reference, std430, buffer_reference_align = 16) buffer Vectors { vec4 at[]; };
layout(buffer_reference, std430, buffer_reference_align = 8) writeonly buffer WordPairs { uvec2 at[]; };
layout(buffer_reference, std430, buffer_reference_align = 4) writeonly buffer Flags { uint at[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) buffer Counters { BenchCounters counters; };
layout(push_constant) uniform Push { BenchParameters bench; };

// --- Rays ---

uint hash(uint x) {
    x = (x ^ x >> 16) * 0x7feb352du;
    x = (x ^ x >> 15) * 0x846ca68bu;
    return x ^ x >> 16;
}

// A workgroup is 16 x 8 pixels, a warp of 32 one tile of 8 x 4.
uvec2 pixelOf(uint index) {
    uint group = index / kBenchGroupSize;
    uint within = index % kBenchGroupSize;
    uint groupsPerRow = bench.width / 16u;
    uint tile = within / 32u;
    uint lane = within % 32u;
    return uvec2(group % groupsPerRow, group / groupsPerRow) * uvec2(16u, 8u) +
           uvec2(tile & 1u, tile >> 1) * uvec2(8u, 4u) + uvec2(lane & 7u, lane >> 3);
}

Ray primaryRay(uint index) {
    vec2 plane = 2.0 * (vec2(pixelOf(index)) + 0.5) / vec2(bench.width, bench.height) - 1.0;
    vec3 direction = bench.forward + plane.x * bench.right - plane.y * bench.up;
    return Ray(bench.eye, kInfinity, normalize(direction), 0.0);
}

// Cosine-distributed about +z.
vec3 cosineDirection(uint seed) {
    uint a = hash(seed * 2u + 1u);
    uint b = hash(a ^ 0x9e3779b9u);
    float u = float(a >> 8) / 16777216.0;
    float angle = 6.2831853 * float(b >> 8) / 16777216.0;
    float radius = sqrt(u);
    return vec3(radius * cos(angle), radius * sin(angle), sqrt(max(1e-6, 1.0 - u)));
}

vec3 aboutFace(vec3 d, uint face) {
    float s = (face & 1u) != 0u ? 1.0 : -1.0;
    return face < 2u ? vec3(s * d.z, d.x, d.y) : face < 4u ? vec3(d.x, s * d.z, d.y) : vec3(d.x, d.y, s * d.z);
}

// In a frame about any unit normal (Duff et al. 2017, "Building an Orthonormal Basis, Revisited").
vec3 aboutNormal(vec3 d, vec3 n) {
    float s = n.z >= 0.0 ? 1.0 : -1.0;
    float a = -1.0 / (s + n.z);
    float b = n.x * n.y * a;
    vec3 tangent = vec3(1.0 + s * n.x * n.x * a, s * b, -s * n.x);
    vec3 bitangent = vec3(b, s + n.y * n.y * a, -n.y);
    return d.x * tangent + d.y * bitangent + d.z * n;
}

Ray rayOf(uint index) {
    if (kKind == kBenchPrimary || kKind == kBenchOrigins) return primaryRay(index);
    vec4 origin = Vectors(bench.origins).at[index];
    if (kKind == kBenchShadow) return Ray(origin.xyz, kInfinity, vec3(0.40824829, 0.81649658, 0.40824829), 0.0);
    uint word = floatBitsToUint(origin.w);
    vec3 direction = cosineDirection(word >> 3);
    uint face = word & 7u;
    if (face == kBenchUseNormal) direction = aboutNormal(direction, Vectors(bench.normals).at[index].xyz);
    else direction = aboutFace(direction, face);
    return Ray(origin.xyz, kInfinity, direction, 0.0);
}

// --- Results ---

void storeMiss(uint index) {
    if (kKind == kBenchShadow) Flags(bench.results).at[index] = 0u;
    else WordPairs(bench.results).at[index] = uvec2(0u);
}

uvec2 packVoxel(uvec3 voxel, uint face) {
    return uvec2(voxel.x | voxel.y << 12 | voxel.z << 24, (voxel.z >> 8 & 15u) | face << 4 | 0x100u);
}

void storeHit(uint index, Ray ray, Hit hit) {
    if (kKind == kBenchShadow) {
        Flags(bench.results).at[index] = 1u;
        return;
    }
    Scene scene = Scene(bench.scene);
    if (kPath == kBenchScene) {
        Surface surface = surfaceOf(scene, ray, hit);
        uvec2 packed = packVoxel(uvec3(surface.voxel), surface.face);
        WordPairs(bench.results).at[index] = uvec2(packed.x, packed.y | surface.material << 12);
        return;
    }
    InstanceRecord instance = Instances(scene.header.instances).at[0];
    ModelRecord model = Models(scene.header.models).at[0];
    CubeHit found = cubeHitOf(model, cubeFromWorldPoint(instance, ray.origin),
                              cubeFromWorldVector(instance, ray.direction), hit);
    WordPairs(bench.results).at[index] = packVoxel(uvec3(found.voxel), found.face);
}

void count(TraceStatistics statistics, bool isHit) {
    if (kCount == 0u) return;
    Counters counters = Counters(bench.counters);
    atomicAdd(counters.counters.steps, statistics.steps);
    atomicAdd(counters.counters.rays, 1u);
    atomicAdd(counters.counters.hits, uint(isHit));
    atomicAdd(counters.counters.stepLimitReached, statistics.stepLimitReached);
}

// --- One ray an invocation ---

Hit castRay(Ray ray, inout TraceStatistics statistics) {
    Scene scene = Scene(bench.scene);
    if (kPath == kBenchScene) return traceScene(scene, ray, kKind == kBenchShadow, statistics);
    Hit hit = missOf(ray);
    Walk walk;
    if (beginInstance(scene.header, 0u, ray, ray.tMax, walk) && finishWalk(walk, statistics)) {
        takeHit(walk, hit);
        hit.instance = 0u;
    }
    return hit;
}

// Where the next ray from a surface starts: a hundredth of a voxel above it.
vec3 originAt(Surface surface) { return surface.position + 0.01 * surface.voxelMetres * surface.normal; }

void castOne(uint index) {
    Ray ray = rayOf(index);
    for (uint bounce = 1u;; ++bounce) {
        TraceStatistics statistics = TraceStatistics(0u, 0u);
        Hit hit = castRay(ray, statistics);
        bool isHit = hit.instance != kNoInstance;
        count(statistics, isHit);
        if (kKind == kBenchDiffuse && kPath == kBenchScene && isHit && bounce < bench.bounces) {
            Surface surface = surfaceOf(Scene(bench.scene), ray, hit);
            vec3 direction = aboutNormal(cosineDirection(hash(index) + bounce), surface.normal);
            ray = Ray(originAt(surface), kInfinity, direction, 0.0);
            continue;
        }
        if (isHit) storeHit(index, ray, hit);
        else storeMiss(index);
        return;
    }
}

// --- Persistent: lanes whose ray has ended take another one ---

// The next instance that the ray meets; of the geometry path, the only one.
bool enterNext(SceneHeader scene, inout SceneWalk walk) {
    if (kPath == kBenchScene) {
        if (kKind == kBenchShadow && walk.hit.instance != kNoInstance) return false;
        return enterNextModel(scene, walk);
    }
    return walk.next++ == 0u && beginInstance(scene, 0u, walk.ray, walk.ray.tMax, walk.model);
}

void store(uint index, SceneWalk walk) {
    if (walk.hit.instance != kNoInstance) storeHit(index, walk.ray, walk.hit);
    else storeMiss(index);
}

void castPersistent() {
    Counters counters = Counters(bench.counters);
    SceneHeader scene = Scene(bench.scene).header;
    SceneWalk walk;
    uint index = 0u;
    bool hasRay = false;
    bool inModel = false;
    bool more = true;
    for (;;) {
        uint waiting = subgroupBallotBitCount(subgroupBallot(!inModel));
        if (waiting >= min(bench.refill, gl_SubgroupSize)) {
            if (hasRay && !inModel) {
                inModel = enterNext(scene, walk);
                if (!inModel) {
                    store(index, walk);
                    hasRay = false;
                }
            }
            uvec4 idleLanes = subgroupBallot(!hasRay);
            uint idleCount = subgroupBallotBitCount(idleLanes);
            if (more && idleCount != 0u) {
                uint first = 0u;
                if (subgroupElect()) first = atomicAdd(counters.counters.next, idleCount);
                first = subgroupBroadcastFirst(first);
                more = first + idleCount < bench.rayCount;
                if (!hasRay) {
                    index = first + subgroupBallotExclusiveBitCount(idleLanes);
                    if (index < bench.rayCount) {
                        walk = beginSceneWalk(scene, rayOf(index));
                        inModel = enterNext(scene, walk);
                        hasRay = inModel;
                        if (!inModel) storeMiss(index);
                    }
                }
            } else if (idleCount == gl_SubgroupSize) {
                return;
            }
        }
        uint state = kWalkGoesOn;
        for (uint i = 0u; i < bench.batch && inModel; ++i) {
            state = stepWalk(walk.model);
            inModel = state == kWalkGoesOn;
        }
        if (state != kWalkGoesOn) leaveModel(walk, state == kWalkHit);
        subgroupBarrier();
    }
}

// --- Where secondary rays start ---

void storeOrigin(uint index) {
    Ray ray = rayOf(index);
    TraceStatistics statistics = TraceStatistics(0u, 0u);
    Hit hit = traceClosest(Scene(bench.scene), ray, statistics);
    if (hit.instance == kNoInstance) {
        Vectors(bench.origins).at[index] = vec4(vec3(0.0), uintBitsToFloat(0xffffffffu));
        return;
    }
    Surface surface = surfaceOf(Scene(bench.scene), ray, hit);
    Vectors(bench.origins).at[index] = vec4(originAt(surface), uintBitsToFloat(surface.face));
    Vectors(bench.normals).at[index] = vec4(surface.normal, 0.0);
}

void main() {
    if (kKind == kBenchReset) {
        if (gl_GlobalInvocationID.x == 0u) Counters(bench.counters).counters = BenchCounters(0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u);
        return;
    }
    if (kKind != kBenchOrigins && kPersistent != 0u) {
        castPersistent();
        return;
    }
    uint index = gl_GlobalInvocationID.x;
    if (index >= bench.rayCount) return;
    if (kKind == kBenchOrigins) storeOrigin(index);
    else castOne(index);
}
