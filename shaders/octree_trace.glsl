// Ray casting in a scene: the one traversal of pfvox. Nothing else on the GPU walks an octree.
//
//     traceClosest / traceAny -> BVH over instances -> traceOctree (one model) -> Hit
//     surfaceOf                                                                -> position, normal, voxel, material
//
// The octree loop is that of Laine and Karras (2010, "Efficient Sparse Voxel Octrees", section 4: push, advance, pop, a
// position whose mantissa spells the path, no t-spans since there are no contours), two levels at a time: a node has
// 4^3 cells (shared/scene.glsl.h). All directions are mirrored to be negative, so a cell's lower planes are its exits,
// and the next position is one unit in the last place below the plane that is met first. Empty 2^3 groups are left in
// one step. A solid cell that rounding makes the ray miss by a hair counts as met: closed surfaces have no leaks at
// their edges. The loop touches nodes and nothing else; materials are looked up once, for the hit that counts.
//
// Rays have any non-zero direction; t counts in its lengths. A ray that starts in a solid voxel hits it at t = 0.
// With Ray::cone above 0 a node that is narrower than the cone stands for all below it, where the scene has levels of
// detail.
#ifndef PFVOX_OCTREE_TRACE_GLSL
#define PFVOX_OCTREE_TRACE_GLSL

#include "shared/scene.glsl.h"

layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer WideNodes { WideNode at[]; };
layout(buffer_reference, std430, buffer_reference_align = 4) readonly buffer Words { uint at[]; };
layout(buffer_reference, std430, buffer_reference_align = 8) readonly buffer Lods { uvec2 at[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer BvhNodes { BvhNode at[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer Instances { InstanceRecord at[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer Models { ModelRecord at[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer Materials { MaterialRecord at[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer Scene { SceneHeader header; };

const float kInfinity = 1e30;
const int kCubeScale = 23;   // cells of scale s have an edge of 2^(s - 23) cubes
const int kRootScale = 21;   // of the root's cells
const uint kNoMaterial = 0xffffffffu;

struct Ray {
    vec3 origin;
    float tMax;
    vec3 direction;
    float cone;  // width of what the ray stands for, in parts of the distance; 0 = every voxel counts
};

// The cell that a ray met. Kept small: it lives in registers through the whole BVH.
struct Hit {
    float t;
    uint instance;  // index of the record, kNoInstance = miss
    uint node;      // of a voxel: its brick; else the node that the cell is
    int scale;      // edge of the cell = 2^(scale - 23) cubes
    vec3 corner;    // lower corner of the cell, cube space
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

// --- Wide nodes ---

uint maskHalf(WideNode node, uint cell) { return (cell & 32u) != 0u ? node.maskHigh : node.maskLow; }

// Number of cells that are not empty before this one.
uint cellsBefore(WideNode node, uint cell) {
    uint before = bitCount(maskHalf(node, cell) & ((1u << (cell & 31u)) - 1u));
    return before + ((cell & 32u) != 0u ? bitCount(node.maskLow) : 0u);
}

uint kindOf(WideNode node) { return node.kind & kWideKindMask; }

uint cellAt(uvec3 position, int scale) {
    uvec3 path = position >> scale & 3u;
    return path.x | path.y << 2 | path.z << 4;
}

float edgeOf(int scale) { return uintBitsToFloat(uint(scale + (127 - kCubeScale)) << 23); }

// --- One model ---

// A ray in the mirrored cube, where all its components are negative. t counts from the entry into the model's tight box,
// where the floats are fine.
struct CubeRay {
    vec3 origin;
    vec3 direction;
    vec3 inverse;
    uvec3 start;    // mantissas of the position at the entry: path bits
    uint flip;      // cell k of the mirrored cube is cell k ^ flip
    bvec3 mirrored;
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
    ray.mirrored = greaterThan(d, vec3(0.0));
    ray.flip = (ray.mirrored.x ? 3u : 0u) | (ray.mirrored.y ? 12u : 0u) | (ray.mirrored.z ? 48u : 0u);
    vec3 entry = origin + ray.tEnter * d;
    ray.origin = mix(entry, 3.0 - entry, ray.mirrored);
    ray.direction = -abs(d);
    ray.inverse = -abs(inverse);
    // Within the box: its upper planes belong to the cells below them.
    uvec3 low = floatBitsToUint(mix(model.boxMin, 3.0 - model.boxMax, ray.mirrored));
    uvec3 high = floatBitsToUint(mix(model.boxMax, 3.0 - model.boxMin, ray.mirrored)) - 1u;
    ray.start = clamp(floatBitsToUint(ray.origin), low, high);
    return ray.tLength >= 0.0;
}

// The axis whose plane comes first. At an edge one axis goes before the other, so that no step is diagonal and nothing
// slips through between two solid cells that touch there.
bvec3 firstAxis(vec3 tPlanes, float tFirst) {
    bvec3 axis = equal(tPlanes, vec3(tFirst));
    axis.y = axis.y && !axis.x;
    axis.z = !(axis.x || axis.y);
    return axis;
}

// Nearest leaf of one model that begins before hit.t. Writes all of `hit` but `instance`, and only when there is one.
bool traceOctree(ModelRecord model, vec3 origin, vec3 direction, float cone, inout Hit hit,
                 inout TraceStatistics statistics) {
    CubeRay ray;
    if (!enterModel(model, origin, direction, hit.t, ray)) return false;
    // Cells below the edge `coneEdge + t * coneGrowth` are not told apart.
    bool detailed = (model.lods.x | model.lods.y) == 0u;
    float coneGrowth = detailed ? 0.0 : cone * length(direction) / ray.speed;

    uint stack[kMaxWideLevels];
    WideNodes nodes = WideNodes(model.nodes);
    uvec3 position = ray.start;
    float t = 0.0;
    int scale = kRootScale;
    uint index = 0u;
    WideNode node = nodes.at[0];

    uint lastStep = statistics.steps + kMaxTraceSteps;
    while (statistics.steps != lastStep) {
        ++statistics.steps;
        uint cell;
        uint cells;
        int hitScale = -1;
        for (;;) {
            cell = cellAt(position, scale) ^ ray.flip;
            cells = maskHalf(node, cell);
            if ((cells >> (cell & 31u) & 1u) == 0u) break;
            if (kindOf(node) != kWideInner) {
                hitScale = scale;
                break;
            }
            // Push
            stack[scale >> 1] = index;
            index = node.child + cellsBefore(node, cell);
            node = nodes.at[index];
            if (kindOf(node) == kWideSolid || edgeOf(scale) < (ray.tEnter + t) * coneGrowth) {
                hitScale = scale;
                break;
            }
            scale -= 2;
        }
        if (hitScale >= 0) {
            hit.t = (ray.tEnter + t) / ray.speed;
            hit.node = index;
            hit.scale = hitScale;
            vec3 corner = uintBitsToFloat(position & ~0u << hitScale);
            hit.corner = mix(corner, 3.0 - edgeOf(hitScale) - corner, ray.mirrored);
            return true;
        }

        // Advance to the exit of the cell, or of its 2^3 group when that is empty.
        bool groupEmpty = (cells >> (cell & 10u) & 0x00330033u) == 0u;
        uint above = ~0u << (groupEmpty ? scale + 1 : scale);
        uvec3 low = position & above;
        vec3 tPlanes = (uintBitsToFloat(low) - ray.origin) * ray.inverse;
        float tExit = minOf(tPlanes);
        bvec3 axis = firstAxis(tPlanes, tExit);
        t = max(t, tExit);  // never back, however coarse the time of a plane almost along the ray is
        if (t > ray.tLength) return false;
        uvec3 inside = clamp(floatBitsToUint(ray.origin + tExit * ray.direction), low, low | ~above);
        uvec3 next = mix(inside, low - 1u, axis);

        // Pop to the node that holds both cells.
        uvec3 changed = next ^ position;
        int level = (findMSB((changed.x | changed.y | changed.z) & ~0u << scale) - 1) | 1;
        position = next;
        if (level > scale) {
            if (level > kRootScale) return false;
            scale = level;
            index = stack[scale >> 1];
            node = nodes.at[index];
        }
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
        if (traceOctree(model, origin, direction, ray.cone, hit, statistics)) {
            hit.instance = i;
            if (anyHit) return true;
        }
    }
    return false;
}

Hit traceScene(Scene sceneBuffer, Ray ray, bool anyHit, inout TraceStatistics statistics) {
    SceneHeader scene = sceneBuffer.header;
    BvhNodes bvh = BvhNodes(scene.bvhNodes);
    Hit hit = Hit(ray.tMax, kNoInstance, 0u, 0, vec3(0.0));
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
    uint material;       // of the scene; of a level of detail: its commonest one
    uint lodColor;       // of a level of detail: R, G, B (sRGB), coverage; else 0
    int leafLog2;        // edge of the cell = 2^leafLog2 voxels
    float voxelMetres;   // extent of a voxel along the normal
};

uint valueAt(ModelRecord model, uint index, bool isShort) {
    uint byteIndex = isShort ? 2u * index : index;
    uint word = Words(model.values).at[byteIndex >> 2u];
    return bitfieldExtract(word, int(8u * (byteIndex & 3u)), isShort ? 16 : 8);
}

// Of the voxel of a brick at this cell.
uint voxelMaterial(ModelRecord model, WideNode brick, uint cell) {
    if (kindOf(brick) != kWideBrick) return brick.child;
    uint value = valueAt(model, brick.child + cellsBefore(brick, cell), (brick.kind & kWideShortValues) != 0u);
    return Words(model.palettes).at[(brick.kind >> kWidePaletteShift) + value];
}

// Whether the hit is a node that stands for smaller leaves.
bool isLevelOfDetail(ModelRecord model, WideNode node, Hit hit) {
    return hit.scale != int(model.leafScale) && kindOf(node) != kWideSolid;
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
    float size = edgeOf(hit.scale);
    float voxelsPerCube = exp2(float(kCubeScale - int(model.leafScale)));

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
    surface.leafLog2 = hit.scale - int(model.leafScale);
    surface.lodColor = 0u;
    WideNode node = WideNodes(model.nodes).at[hit.node];
    if (isLevelOfDetail(model, node, hit)) {
        uvec2 lod = Lods(model.lods).at[hit.node];
        surface.lodColor = lod.x;
        surface.material = lod.y;
    } else {
        surface.material = voxelMaterial(model, node, uint(leafMin.x & 3) | uint(leafMin.y & 3) << 2 |
                                                      uint(leafMin.z & 3) << 4);
    }
    return surface;
}

// Material of a leaf that is cell `cell` of this node, kNoMaterial when that is empty or no leaf.
uint leafMaterial(ModelRecord model, WideNode node, uint cell) {
    if ((maskHalf(node, cell) >> (cell & 31u) & 1u) == 0u) return kNoMaterial;
    if (kindOf(node) != kWideInner) return voxelMaterial(model, node, cell);
    WideNode child = WideNodes(model.nodes).at[node.child + cellsBefore(node, cell)];
    return kindOf(child) == kWideSolid ? child.child : kNoMaterial;
}

// Edge of the leaf in the octree of the file: eight leaves of one material that the wide node tells apart are one
// there. Walks down from the root: for inspection, not for speed.
int octreeLeafLog2(Scene sceneBuffer, Hit hit) {
    SceneHeader scene = sceneBuffer.header;
    ModelRecord model = Models(scene.models).at[Instances(scene.instances).at[hit.instance].model];
    uvec3 position = floatBitsToUint(hit.corner);
    WideNode node = WideNodes(model.nodes).at[0];
    for (int scale = kRootScale; scale > hit.scale; scale -= 2) {
        node = WideNodes(model.nodes).at[node.child + cellsBefore(node, cellAt(position, scale))];
    }
    uint group = cellAt(position, hit.scale) & 42u;  // its first cell
    uint first = leafMaterial(model, node, group);
    bool same = first != kNoMaterial;
    for (uint sub = 1u; sub < 8u && same; ++sub) {
        uint cell = group + (sub & 1u) + (sub >> 1 & 1u) * 4u + (sub >> 2) * 16u;
        same = leafMaterial(model, node, cell) == first;
    }
    return hit.scale - int(model.leafScale) + (same ? 1 : 0);
}

vec3 linearFromSrgb(vec3 c) {
    return mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), greaterThan(c, vec3(0.04045)));
}

// Base colour of what was hit, linear.
vec3 albedoOf(Scene scene, Surface surface) {
    if (surface.lodColor != 0u) return linearFromSrgb(unpackUnorm4x8(surface.lodColor).rgb);
    return Materials(scene.header.materials).at[surface.material].albedo;
}

#endif
