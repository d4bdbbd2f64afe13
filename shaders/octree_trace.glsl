// Ray casting in a scene: the one traversal of pfvox. Nothing else on the GPU walks an octree.
//
//     traceClosest / traceAny -> BVH over instances -> traceOctree (one model) -> Hit
//     surfaceOf                                                                -> position, normal, voxel, material
//
// The octree loop is that of Laine and Karras (2010, "Efficient Sparse Voxel Octrees", section 4), without contours:
// all directions are mirrored to be negative, a cell's exit is the nearest of its three lower planes, and the level to
// pop to is the highest mantissa bit that the step has changed. The stack holds node indices only; the span that the
// paper keeps beside them serves contours. A solid cell that rounding makes the ray miss by a hair counts as met: closed
// surfaces have no leaks at their edges. The loop touches nodes (and far words) and nothing else; materials are
// looked up once, for the hit that counts.
//
// Rays have any non-zero direction; t counts in its lengths. A ray that starts in a solid voxel hits it at t = 0.
#ifndef PFVOX_OCTREE_TRACE_GLSL
#define PFVOX_OCTREE_TRACE_GLSL

#include "shared/scene.glsl.h"

layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer TreeBlock {
    TreeBlockHeader header;
    uint words[];
};
layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer BvhNodes { BvhNode at[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer Instances { InstanceRecord at[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer Models { ModelRecord at[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer Materials { MaterialRecord at[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer Scene { SceneHeader header; };

const float kInfinity = 1e30;
const uint kCubeScale = 23u;  // cells of scale s have an edge of 2^(s - 23); the root's children have scale 22

struct Ray {
    vec3 origin;
    float tMax;
    vec3 direction;
};

// The leaf that a ray met. Kept small: it lives in registers through the whole BVH.
struct Hit {
    float t;
    uint instance;  // index of the record, kNoInstance = miss
    uvec2 block;    // region that holds the leaf
    uint node;      // in that region
    uint slot;      // child slot of the leaf
    uint scale;     // edge of the leaf = 2^(scale - 23) cubes
    vec3 corner;    // lower corner of the leaf, cube space
};

struct TraceStatistics {
    uint steps;
    uint capped;
};

// --- Small helpers ---

// A direction whose longest component is 1, without zeros, so that no quotient by it is infinite or NaN. What is added
// turns a ray by less than one voxel over the deepest octree.
vec3 boundedDirection(vec3 d) {
    const float tiny = 1.1920929e-7;  // 2^-23
    return mix(d, mix(vec3(tiny), vec3(-tiny), lessThan(d, vec3(0.0))), lessThan(abs(d), vec3(tiny)));
}

float minOf(vec3 v) { return min(v.x, min(v.y, v.z)); }
float maxOf(vec3 v) { return max(v.x, max(v.y, v.z)); }

// Span of the ray origin + t / inverse within a box. Rounding is met by a relative margin on the exit, so that rays
// within a face are kept.
vec2 boxSpan(vec3 boxMin, vec3 boxMax, vec3 origin, vec3 inverse) {
    vec3 a = (boxMin - origin) * inverse;
    vec3 b = (boxMax - origin) * inverse;
    return vec2(maxOf(min(a, b)), minOf(max(a, b)) * 1.000001);
}

vec3 cubeFromWorldPoint(InstanceRecord instance, vec3 p) {
    return vec3(dot(instance.cubeFromWorld0.xyz, p) + instance.cubeFromWorld0.w,
                dot(instance.cubeFromWorld1.xyz, p) + instance.cubeFromWorld1.w,
                dot(instance.cubeFromWorld2.xyz, p) + instance.cubeFromWorld2.w);
}

vec3 cubeFromWorldVector(InstanceRecord instance, vec3 v) {
    return vec3(dot(instance.cubeFromWorld0.xyz, v), dot(instance.cubeFromWorld1.xyz, v),
                dot(instance.cubeFromWorld2.xyz, v));
}

// The region block behind a leaf of the top tree.
uvec2 regionBlockOf(TreeBlock top, uint node, uint leaves, uint slot) {
    uint region = top.words[top.header.lookupOffset + node] + bitCount(leaves & ((1u << slot) - 1u));
    uint word = top.header.valuesOffset + 2u * region;
    return uvec2(top.words[word], top.words[word + 1u]);
}

// --- One model ---

uint bitsOf(bvec3 v) { return uint(v.x) | uint(v.y) << 1 | uint(v.z) << 2; }
uint bitsOf(uvec3 v) { return (v.x & 1u) | (v.y & 1u) << 1 | (v.z & 1u) << 2; }

// A ray in the mirrored cube, where all its components are negative: plane p of an axis is met at t = p * c - b. t
// counts from the entry into the model's tight box, where the floats are fine.
struct CubeRay {
    vec3 c;
    vec3 b;
    bvec3 mirrored;
    float tMin;
    float tLength;  // to the end of the box or of the ray
    float tEnter;   // what t = 0 is for the caller, times `speed`
    float speed;    // longest component of the caller's direction
};

// False when the ray does not meet the box before tMax.
bool enterModel(ModelRecord model, vec3 origin, vec3 direction, float tMax, out CubeRay ray) {
    // The longest component becomes 1: steps then have the precision of the cube whatever the ray's length unit is.
    ray.speed = maxOf(abs(direction));
    vec3 d = boundedDirection(direction / ray.speed);
    vec3 inverse = 1.0 / d;
    vec2 span = boxSpan(model.boxMin, model.boxMax, origin, inverse);
    ray.tEnter = max(span.x, 0.0);
    ray.tLength = min(span.y, tMax * ray.speed) - ray.tEnter;
    ray.c = -abs(inverse);
    ray.b = ray.c * (origin + ray.tEnter * d);
    ray.mirrored = greaterThan(d, vec3(0.0));
    ray.b = mix(ray.b, 3.0 * ray.c - ray.b, ray.mirrored);
    ray.tMin = max(maxOf(2.0 * ray.c - ray.b), 0.0);
    return ray.tLength >= 0.0;
}

// The half of a node that holds the ray at tMin, axis by axis: moves `corner` from the node's to that child's and returns
// the child's number. tCentre: when the planes through the node's centre are met.
uint enterChild(vec3 tCentre, float tMin, float halfSize, inout vec3 corner) {
    bvec3 upper = greaterThan(tCentre, vec3(tMin));
    corner = mix(corner, corner + halfSize, upper);
    return bitsOf(upper);
}

// The axis whose far plane comes first. At an edge one axis goes before the other, so that no step is diagonal and
// nothing slips through between two solid cells that touch there.
bvec3 nextAxis(vec3 tExit, float tCell) {
    bvec3 axis = lessThanEqual(tExit, vec3(tCell));
    axis.y = axis.y && !axis.x;
    axis.z = !(axis.x || axis.y);
    return axis;
}

// Index of an inner child. The far table is hardly ever read.
uint childNode(TreeBlock block, uint node, uint descriptor, uint slot) {
    uint inner = descriptor >> 8u & ~descriptor & 0xffu;
    uint distance = descriptor >> 17u;
    if ((descriptor & 0x10000u) != 0u) distance = block.words[block.header.farOffset + distance];
    return node + distance + bitCount(inner & ((1u << slot) - 1u));
}

// Nearest leaf of one model that begins before hit.t. Writes all of `hit` but `instance`, and only when there is one.
bool traceOctree(ModelRecord model, vec3 origin, vec3 direction, inout Hit hit, inout TraceStatistics statistics) {
    CubeRay ray;
    if (!enterModel(model, origin, direction, hit.t, ray)) return false;
    uint mirrorBits = bitsOf(ray.mirrored);
    float tMin = ray.tMin;

    uint stack[kOctreeStackSize];
    TreeBlock root = TreeBlock(model.rootBlock);
    TreeBlock block = root;
    uint node = 0u;
    uint descriptor = 0u;  // 0 = not loaded: no node has it
    uint scale = kCubeScale - 1u;
    float size = 0.5;
    vec3 corner = vec3(1.0);
    uint child = enterChild(1.5 * ray.c - ray.b, tMin, size, corner);

    uint lastStep = statistics.steps + kMaxTraceSteps;
    while (statistics.steps != lastStep) {
        ++statistics.steps;
        if (descriptor == 0u) descriptor = block.words[node];
        vec3 tExit = corner * ray.c - ray.b;
        float tCell = minOf(tExit);
        uint slot = child ^ mirrorBits;

        if ((descriptor >> (8u + slot) & 1u) != 0u) {
            stack[scale] = node;
            if ((descriptor >> slot & 1u) == 0u) {
                node = childNode(block, node, descriptor, slot);
            } else if (scale > model.regionScale) {
                block = TreeBlock(regionBlockOf(block, node, descriptor & 0xffu, slot));
                node = 0u;
            } else {
                hit.t = (ray.tEnter + tMin) / ray.speed;
                hit.block = uvec2(block);
                hit.node = node;
                hit.slot = slot;
                hit.scale = scale;
                hit.corner = mix(corner, 3.0 - size - corner, ray.mirrored);
                return true;
            }
            // Push
            size *= 0.5;
            child = enterChild(size * ray.c + tExit, tMin, size, corner);
            --scale;
            descriptor = 0u;
            continue;
        }

        // Advance
        bvec3 axis = nextAxis(tExit, tCell);
        uint axisBit = bitsOf(axis);
        vec3 before = corner;
        corner = mix(corner, corner - size, axis);
        tMin = max(tMin, tCell);  // never back, however coarse the time of a plane almost along the ray is
        if (tMin > ray.tLength) return false;
        child ^= axisBit;
        if ((child & axisBit) == 0u) continue;

        // Pop: from a lower to an upper half is out of the node. The highest bit of the path that changed tells how far.
        uvec3 changed = floatBitsToUint(before) ^ floatBitsToUint(corner);
        scale = uint(findMSB(changed.x | changed.y | changed.z));
        if (scale >= kCubeScale) return false;
        size = uintBitsToFloat((scale + (127u - kCubeScale)) << 23);
        node = stack[scale];
        if (scale > model.regionScale) block = root;
        uvec3 path = floatBitsToUint(corner) >> scale;
        corner = uintBitsToFloat(path << scale);
        child = bitsOf(path);
        descriptor = 0u;
    }
    statistics.capped = 1u;
    return false;
}

// --- All instances ---

bool traceInstances(SceneHeader scene, BvhNode leaf, Ray ray, bool anyHit, inout Hit hit,
                    inout TraceStatistics statistics) {
    for (uint i = leaf.first; i < leaf.first + leaf.count; ++i) {
        InstanceRecord instance = Instances(scene.instances).at[i];
        ModelRecord model = Models(scene.models).at[instance.model];
        vec3 origin = cubeFromWorldPoint(instance, ray.origin);
        vec3 direction = cubeFromWorldVector(instance, ray.direction);
        if (traceOctree(model, origin, direction, hit, statistics)) {
            hit.instance = i;
            if (anyHit) return true;
        }
    }
    return false;
}

Hit traceScene(Scene sceneBuffer, Ray ray, bool anyHit, inout TraceStatistics statistics) {
    SceneHeader scene = sceneBuffer.header;
    BvhNodes bvh = BvhNodes(scene.bvhNodes);
    Hit hit = Hit(ray.tMax, kNoInstance, uvec2(0u), 0u, 0u, 0u, vec3(0.0));
    if (scene.instanceCount == 0u) return hit;

    // Boxes are tested in lengths of the direction; only the order of magnitude of its components is bounded.
    vec3 inverse = 1.0 / (boundedDirection(ray.direction / maxOf(abs(ray.direction))) * maxOf(abs(ray.direction)));
    uint stack[kBvhStackSize];
    uint stackSize = 0u;
    BvhNode node = bvh.at[0];
    for (;;) {
        if (node.count != 0u) {
            if (traceInstances(scene, node, ray, anyHit, hit, statistics)) return hit;
        } else {
            BvhNode left = bvh.at[node.first];
            BvhNode right = bvh.at[node.first + 1u];
            vec2 spanLeft = boxSpan(left.boxMin, left.boxMax, ray.origin, inverse);
            vec2 spanRight = boxSpan(right.boxMin, right.boxMax, ray.origin, inverse);
            bool enterLeft = spanLeft.y >= max(spanLeft.x, 0.0) && spanLeft.x <= hit.t;
            bool enterRight = spanRight.y >= max(spanRight.x, 0.0) && spanRight.x <= hit.t;
            if (enterLeft && enterRight) {
                bool leftFirst = spanLeft.x <= spanRight.x;
                stack[stackSize++] = leftFirst ? node.first + 1u : node.first;
                node = leftFirst ? left : right;
                continue;
            }
            if (enterLeft || enterRight) {
                node = enterLeft ? left : right;
                continue;
            }
        }
        // The next box that is still nearer than what was hit since it was put aside.
        bool found = false;
        while (!found && stackSize != 0u) {
            node = bvh.at[stack[--stackSize]];
            vec2 span = boxSpan(node.boxMin, node.boxMax, ray.origin, inverse);
            found = span.x <= hit.t;
        }
        if (!found) return hit;
    }
}

Hit traceClosest(Scene scene, Ray ray, inout TraceStatistics statistics) {
    return traceScene(scene, ray, false, statistics);
}

bool traceAny(Scene scene, Ray ray, inout TraceStatistics statistics) {
    return traceScene(scene, ray, true, statistics).instance != kNoInstance;
}

// --- What was hit ---

struct Surface {
    vec3 position;  // metres
    vec3 normal;    // unit length, against the ray
    uint face;
    ivec3 voxel;         // model voxels
    uint material;       // of the scene
    uint leafLog2;       // edge of the leaf = 2^leafLog2 voxels
    float voxelMetres;   // extent of a voxel along the normal
};

uint valueAt(TreeBlock region, uint index) {
    uint perWordLog2 = region.header.valueBits == 8u ? 2u : 1u;
    uint word = region.words[region.header.valuesOffset + (index >> perWordLog2)];
    uint place = index & ((1u << perWordLog2) - 1u);
    return bitfieldExtract(word, int(place * region.header.valueBits), int(region.header.valueBits));
}

uint materialOfSlot(TreeBlock region, uint lookup, uint slot) {
    uint index = (lookup >> 8u) + bitCount(lookup & ((1u << slot) - 1u) & 0xffu);
    return region.words[region.header.paletteOffset + valueAt(region, index)];
}

// A leaf without a value of its own lies below a slot that has it for its whole subtree. Values below such a slot do
// not exist, so the first one met on the way down from the region's root is the right one.
uint hoistedMaterial(TreeBlock region, ModelRecord model, Hit hit) {
    uvec3 path = floatBitsToUint(hit.corner);
    uint node = 0u;
    for (uint scale = min(model.regionScale, kCubeScale - 1u);; --scale) {
        uint slot = bitsOf(path >> scale);
        uint lookup = region.words[region.header.lookupOffset + node];
        if ((lookup >> slot & 1u) != 0u) return materialOfSlot(region, lookup, slot);
        if (scale <= hit.scale) return 0u;  // not in a valid tree
        node = childNode(region, node, region.words[node], slot);
    }
}

uint materialOf(ModelRecord model, Hit hit) {
    TreeBlock region = TreeBlock(hit.block);
    uint lookup = region.words[region.header.lookupOffset + hit.node];
    if ((lookup >> hit.slot & 1u) != 0u) return materialOfSlot(region, lookup, hit.slot);
    return hoistedMaterial(region, model, hit);
}

// The face through which the ray entered the leaf: the one of its three near planes that it met last. A plane that the
// ray runs along is never that one.
uint enteredAxis(vec3 origin, vec3 direction, vec3 near, out bool inside) {
    const float never = -kInfinity;
    float parallel = 1e-6 * maxOf(abs(direction));
    vec3 t = mix((near - origin) / direction, vec3(never), lessThan(abs(direction), vec3(parallel)));
    float last = maxOf(t);
    inside = last < 0.0;
    return t.x == last ? 0u : t.y == last ? 1u : 2u;
}

Surface surfaceOf(Scene sceneBuffer, Ray ray, Hit hit) {
    SceneHeader scene = sceneBuffer.header;
    InstanceRecord instance = Instances(scene.instances).at[hit.instance];
    ModelRecord model = Models(scene.models).at[instance.model];
    vec3 origin = cubeFromWorldPoint(instance, ray.origin);
    vec3 direction = cubeFromWorldVector(instance, ray.direction);
    float size = exp2(float(hit.scale) - float(kCubeScale));
    float voxelsPerCube = exp2(float(model.depth));

    Surface surface;
    bool inside;
    bvec3 positive = greaterThan(direction, vec3(0.0));
    uint axis = enteredAxis(origin, direction, mix(hit.corner + size, hit.corner, positive), inside);
    surface.face = inside ? kFaceInside : 2u * axis + (positive[axis] ? 0u : 1u);

    // The leaf may be larger than a voxel: the voxel is the one at the hit point, held within the leaf.
    ivec3 leafMin = ivec3((hit.corner - 1.0) * voxelsPerCube);
    int leafEdge = int(size * voxelsPerCube);
    ivec3 voxel = ivec3(floor((origin + hit.t * direction - 1.0) * voxelsPerCube));
    if (!inside) voxel[axis] = positive[axis] ? leafMin[axis] : leafMin[axis] + leafEdge - 1;
    surface.voxel = model.originVoxels + clamp(voxel, leafMin, leafMin + leafEdge - 1);

    vec3 row = axis == 0u ? instance.cubeFromWorld0.xyz
             : axis == 1u ? instance.cubeFromWorld1.xyz : instance.cubeFromWorld2.xyz;
    float stretch = length(row);
    surface.normal = (positive[axis] ? -row : row) / stretch;
    surface.voxelMetres = 1.0 / (stretch * voxelsPerCube);
    surface.position = ray.origin + hit.t * ray.direction;
    surface.material = materialOf(model, hit);
    surface.leafLog2 = model.depth + hit.scale - kCubeScale;
    return surface;
}

#endif
