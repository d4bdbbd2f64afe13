// Ray casting in a scene: the one traversal of pfvox. Nothing else on the GPU walks an octree.
//
//     traceClosest / traceAny -> BVH over instances -> Walk (one model) -> Hit
//     surfaceOf                                                         -> position, normal, voxel, material
//
// The octree loop is that of Laine and Karras (2010, "Efficient Sparse Voxel Octrees", section 4: push, advance, pop, a
// position whose mantissa spells the path, no t-spans since there are no contours), two levels at a time: a node has
// 4^3 cells (shared/scene.glsl.h). All directions are mirrored to be negative, so a cell's lower planes are its exits,
// and the next position is one unit in the last place below the plane that is met first. Empty 2^3 groups are left in
// one step. A solid cell that rounding makes the ray miss by a hair counts as met: closed surfaces have no leaks at
// their edges. The loop touches nodes and nothing else; materials are looked up once, for the hit that counts.
//
// Rays have any direction but zero (one whose components are all below 1e-36 hits nothing); t counts in its lengths. A ray that starts in a solid voxel hits it at t = 0.
//
// The includer defines PFVOX_TRACE_GROUP_SIZE, the invocations of its workgroup. With PFVOX_TRACE_LOD a node that is
// narrower than the ray's cone stands for all below it, where the scene has levels of detail; the test costs a tenth of
// the speed of persistent programs, so it is not there without.
#ifndef PFVOX_OCTREE_TRACE_GLSL
#define PFVOX_OCTREE_TRACE_GLSL

#include "shared/color.glsl.h"
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
const float kShortestDirection = 1e-36;  // devices may take anything below 1.2e-38 for zero
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
    uint axis;      // of the face through which the ray came into the cell; kAxisInside = it starts there
};
const uint kAxisInside = 3u;

struct TraceStatistics {
    uint steps;
    uint stepLimitReached;
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

// A ray on its way through one model, in the mirrored cube, where all its components are negative. t counts from the
// entry into the model's tight box, where the floats are fine.
struct Walk {
    vec3 origin;
    vec3 direction;
    vec3 inverse;
    uvec3 position;   // mantissas: path bits
    uint flip;        // cell k of the mirrored cube is cell k ^ flip
    float t;
    float tLength;    // to the end of the box or of the ray
    float tEnter;     // what t = 0 is for the caller, times `speed`
    float speed;      // longest component of the caller's direction
    float coneGrowth;  // cells of an edge below (tEnter + t) * coneGrowth are not told apart
    uvec2 nodes;
    WideNode node;    // the one that the position is in
    uint index;
    int scale;        // of its cells
};

// Nodes above the one that the walk is in, by scale. In shared memory: a fifth faster there than in the private kind.
shared uint walkStack[kMaxWideLevels * PFVOX_TRACE_GROUP_SIZE];
uint walkStackIndex(int scale) { return uint(scale >> 1) * PFVOX_TRACE_GROUP_SIZE + gl_LocalInvocationIndex; }

const uint kWalkGoesOn = 0u;
const uint kWalkHit = 1u;   // at the cell at `position` of scale `scale`, in node `index`
const uint kWalkLeft = 2u;

bvec3 mirroredAxes(uint flip) { return notEqual(uvec3(flip) & uvec3(1u, 4u, 16u), uvec3(0u)); }

// False when the ray does not meet the model's box before tMax.
bool beginWalk(ModelRecord model, vec3 origin, vec3 direction, float tMax, float cone, out Walk walk) {
    // The longest component becomes 1: steps then have the precision of the cube whatever the ray's length unit is.
    walk.speed = maxOf(abs(direction));
    vec3 d = boundedDirection(direction / walk.speed);
    vec3 inverse = 1.0 / d;
    vec2 span = boxSpan(model.boxMin, model.boxMax, origin, inverse);
    walk.tEnter = max(span.x, 0.0);
    walk.tLength = min(span.y, tMax * walk.speed) - walk.tEnter;
    bvec3 mirrored = greaterThan(d, vec3(0.0));
    walk.flip = (mirrored.x ? 3u : 0u) | (mirrored.y ? 12u : 0u) | (mirrored.z ? 48u : 0u);
    vec3 entry = origin + walk.tEnter * d;
    walk.origin = mix(entry, 3.0 - entry, mirrored);
    walk.direction = -abs(d);
    walk.inverse = -abs(inverse);
    // Within the box: its upper planes belong to the cells below them.
    uvec3 low = floatBitsToUint(mix(model.boxMin, 3.0 - model.boxMax, mirrored));
    uvec3 high = floatBitsToUint(mix(model.boxMax, 3.0 - model.boxMin, mirrored)) - 1u;
    walk.position = clamp(floatBitsToUint(walk.origin), low, high);
    bool hasLods = (model.lods.x | model.lods.y) != 0u;
    walk.coneGrowth = hasLods ? cone * length(d) : 0.0;
    walk.t = 0.0;
    walk.scale = kRootScale;
    walk.nodes = model.nodes;
    walk.index = 0u;
    walk.node = WideNodes(model.nodes).at[0];
    // A direction that the device takes for zero has no length to count in.
    return walk.tLength >= 0.0 && walk.speed >= kShortestDirection;
}

// The axis whose plane comes first. At an edge one axis goes before the other, so that no step is diagonal and nothing
// slips through between two solid cells that touch there.
bvec3 firstAxis(vec3 tPlanes, float tFirst) {
    bvec3 axis = equal(tPlanes, vec3(tFirst));
    axis.y = axis.y && !axis.x;
    axis.z = !(axis.x || axis.y);
    return axis;
}

// On to the cell behind the one of this scale at the position.
uint leaveCell(inout Walk walk, int scale) {
    uint above = ~0u << scale;
    uvec3 low = walk.position & above;
    vec3 tPlanes = (uintBitsToFloat(low) - walk.origin) * walk.inverse;
    float tExit = minOf(tPlanes);
    bvec3 axis = firstAxis(tPlanes, tExit);
    // Never back, neither the time nor with it the position, however coarse the time of a plane almost along the ray is.
    walk.t = max(walk.t, tExit);
    if (walk.t > walk.tLength) return kWalkLeft;
    uvec3 inside = clamp(floatBitsToUint(walk.origin + walk.t * walk.direction), low, low | ~above);
    uvec3 next = mix(inside, low - 1u, axis);

    // Pop to the node that holds both cells.
    uvec3 changed = next ^ walk.position;
    int level = (findMSB((changed.x | changed.y | changed.z) & ~0u << walk.scale) - 1) | 1;
    walk.position = next;
    if (level > walk.scale) {
        if (level > kRootScale) return kWalkLeft;
        walk.scale = level;
        walk.index = walkStack[walkStackIndex(level)];
        walk.node = WideNodes(walk.nodes).at[walk.index];
    }
    return kWalkGoesOn;
}

// Down to the smallest cell at the position, then on to the next one.
uint stepWalk(inout Walk walk) {
    uint cell;
    uint cells;
    for (;;) {
        cell = cellAt(walk.position, walk.scale) ^ walk.flip;
        cells = maskHalf(walk.node, cell);
        if ((cells >> (cell & 31u) & 1u) == 0u) break;
        if (kindOf(walk.node) != kWideInner) return kWalkHit;
        // Push
        walkStack[walkStackIndex(walk.scale)] = walk.index;
        walk.index = walk.node.child + cellsBefore(walk.node, cell);
        walk.node = WideNodes(walk.nodes).at[walk.index];
        if (kindOf(walk.node) == kWideSolid) return kWalkHit;
#ifdef PFVOX_TRACE_LOD
        if (edgeOf(walk.scale) < (walk.tEnter + walk.t) * walk.coneGrowth) return kWalkHit;
#endif
        walk.scale -= 2;
    }

    // The cell is empty, and perhaps its 2^3 group with it.
    bool groupEmpty = (cells >> (cell & 10u) & 0x00330033u) == 0u;
    return leaveCell(walk, groupEmpty ? walk.scale + 1 : walk.scale);
}

// On from the solid cell that stepWalk has stopped at, for rays that go through some materials.
uint passCell(inout Walk walk) {
    if (kindOf(walk.node) == kWideSolid) {  // the cell is a node: back to the one it is a cell of
        walk.index = walkStack[walkStackIndex(walk.scale)];
        walk.node = WideNodes(walk.nodes).at[walk.index];
    }
    return leaveCell(walk, walk.scale);
}

// The axis of the last step, told from its time by the sums that the step was made of: where planes are met at once the walk
// goes along x first and along z last, so that the face is one that the ray has seen, not one between two solid cells.
uint enteredAxis(Walk walk, vec3 corner) {
    vec3 tNear = (corner + edgeOf(walk.scale) - walk.origin) * walk.inverse;
    float last = maxOf(tNear);
    if (walk.tEnter + last < 0.0) return kAxisInside;
    if (any(equal(tNear, vec3(walk.t)))) last = walk.t;
    return tNear.z == last ? 2u : tNear.y == last ? 1u : 0u;
}

// What a walk that has hit found: all of `hit` but `instance`.
void takeHit(Walk walk, inout Hit hit) {
    bvec3 mirrored = mirroredAxes(walk.flip);
    vec3 corner = uintBitsToFloat(walk.position & ~0u << walk.scale);
    hit.axis = enteredAxis(walk, corner);
    hit.t = (walk.tEnter + walk.t) / walk.speed;
    hit.node = walk.index;
    hit.scale = walk.scale;
    hit.corner = mix(corner, 3.0 - edgeOf(walk.scale) - corner, mirrored);
}

// The rest of a walk; true when it ends at a hit.
bool finishWalk(inout Walk walk, inout TraceStatistics statistics) {
    uint lastStep = statistics.steps + kMaxTraceSteps;
    uint state;
    do {
        ++statistics.steps;
        state = stepWalk(walk);
    } while (state == kWalkGoesOn && statistics.steps != lastStep);
    if (state == kWalkGoesOn) statistics.stepLimitReached = 1u;
    return state == kWalkHit;
}

// --- All instances ---

// A ray on its way through the BVH. Boxes are tested in lengths of its direction.
struct BvhWalk {
    vec3 origin;
    vec3 inverse;
    uint node;       // to be entered next; kNoBvhNode = the top of the stack
    uint stackSize;
};
const uint kNoBvhNode = 0xffffffffu;
uint bvhStack[kBvhStackSize];

BvhWalk beginBvhWalk(SceneHeader scene, Ray ray) {
    // Only the order of magnitude of the components is bounded.
    float longest = maxOf(abs(ray.direction));
    vec3 inverse = 1.0 / (boundedDirection(ray.direction / longest) * longest);
    return BvhWalk(ray.origin, inverse, scene.instanceCount == 0u ? kNoBvhNode : 0u, 0u);
}

// The next leaf whose box the ray meets before tMax. False when there is none any more.
bool nextBvhLeaf(BvhNodes bvh, inout BvhWalk walk, float tMax, out BvhNode leaf) {
    for (;;) {
        if (walk.node == kNoBvhNode) {
            if (walk.stackSize == 0u) return false;
            leaf = bvh.at[bvhStack[--walk.stackSize]];
            // It was put aside before what has been hit since.
            if (boxSpan(leaf.boxMin, leaf.boxMax, walk.origin, walk.inverse).x > tMax) continue;
        } else {
            leaf = bvh.at[walk.node];
        }
        walk.node = kNoBvhNode;
        if (leaf.count != 0u) return true;
        BvhNode left = bvh.at[leaf.first];
        BvhNode right = bvh.at[leaf.first + 1u];
        vec2 spanLeft = boxSpan(left.boxMin, left.boxMax, walk.origin, walk.inverse);
        vec2 spanRight = boxSpan(right.boxMin, right.boxMax, walk.origin, walk.inverse);
        bool enterLeft = spanLeft.y >= max(spanLeft.x, 0.0) && spanLeft.x <= tMax;
        bool enterRight = spanRight.y >= max(spanRight.x, 0.0) && spanRight.x <= tMax;
        bool leftFirst = enterLeft && (!enterRight || spanLeft.x <= spanRight.x);
        if (enterLeft && enterRight) bvhStack[walk.stackSize++] = leaf.first + uint(leftFirst);
        if (enterLeft || enterRight) walk.node = leaf.first + uint(!leftFirst);
    }
}

Hit missOf(Ray ray) { return Hit(ray.tMax, kNoInstance, 0u, 0, vec3(0.0), 0u); }

bool beginInstance(SceneHeader scene, uint index, Ray ray, float tMax, out Walk walk) {
    InstanceRecord instance = Instances(scene.instances).at[index];
    ModelRecord model = Models(scene.models).at[instance.model];
    return beginWalk(model, cubeFromWorldPoint(instance, ray.origin), cubeFromWorldVector(instance, ray.direction),
                     tMax, ray.cone, walk);
}

// The one way through all instances, nearest boxes first: enterNextModel, then walk.model to its end, then leaveModel, and
// again. Whoever traces decides in between what a hit means: the closest, any, glass that is passed. In pieces, because
// lanes of some programs go on to another ray as soon as theirs has ended (Aila and Laine 2009, "Understanding the
// Efficiency of Ray Traversal on GPUs").
struct SceneWalk {
    Ray ray;
    Hit hit;
    BvhWalk bvhWalk;
    uint next;  // instances of the BVH leaf that are still to be walked
    uint end;
    Walk model;
};

SceneWalk beginSceneWalk(SceneHeader scene, Ray ray) {
    SceneWalk walk;
    walk.ray = ray;
    walk.hit = missOf(ray);
    walk.bvhWalk = beginBvhWalk(scene, ray);
    walk.next = 0u;
    walk.end = 0u;
    return walk;
}

// False when walk.hit is what there is.
bool enterNextModel(SceneHeader scene, inout SceneWalk walk) {
    for (;;) {
        while (walk.next != walk.end) {
            if (beginInstance(scene, walk.next++, walk.ray, walk.hit.t, walk.model)) return true;
        }
        BvhNode leaf;
        if (!nextBvhLeaf(BvhNodes(scene.bvhNodes), walk.bvhWalk, walk.hit.t, leaf)) return false;
        walk.next = leaf.first;
        walk.end = leaf.first + leaf.count;
    }
}

uint instanceOf(SceneWalk walk) { return walk.next - 1u; }

void leaveModel(inout SceneWalk walk, bool hit) {
    if (!hit) return;
    takeHit(walk.model, walk.hit);
    walk.hit.instance = instanceOf(walk);
}

Hit traceScene(Scene sceneBuffer, Ray ray, bool anyHit, inout TraceStatistics statistics) {
    SceneHeader scene = sceneBuffer.header;
    SceneWalk walk = beginSceneWalk(scene, ray);
    while (enterNextModel(scene, walk)) {
        bool hit = finishWalk(walk.model, statistics);
        leaveModel(walk, hit);
        if (anyHit && hit) break;
    }
    return walk.hit;
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
    vec3 lift;      // from the position to where rays leave the surface, metres
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

// A hit within its model.
struct CubeHit {
    uint axis;  // of the face
    uint face;
    bool positive;    // the ray goes up along that axis
    ivec3 voxel;      // from the cube's corner
    ivec3 leafMin;    // of the cell that was hit
    vec3 within;      // of the hit point in the voxel, in voxels; rounding may put it a little outside
};

CubeHit cubeHitOf(ModelRecord model, vec3 origin, vec3 direction, Hit hit) {
    float size = edgeOf(hit.scale);
    float voxelsPerCube = edgeOf(2 * kCubeScale - int(model.leafScale));
    CubeHit found;
    bool inside = hit.axis == kAxisInside;
    bvec3 positive = greaterThan(direction, vec3(0.0));
    vec3 along = abs(direction);
    found.axis = !inside ? hit.axis : along.x >= maxOf(along) ? 0u : along.y >= along.z ? 1u : 2u;
    found.positive = positive[found.axis];
    found.face = inside ? kFaceInside : 2u * found.axis + (found.positive ? 0u : 1u);

    // The leaf may be larger than a voxel: the voxel is the one at the hit point, held within the leaf.
    found.leafMin = ivec3((hit.corner - 1.0) * voxelsPerCube);
    ivec3 leafMax = found.leafMin + int(size * voxelsPerCube) - 1;
    vec3 point = (origin + hit.t * direction - 1.0) * voxelsPerCube;
    ivec3 voxel = ivec3(floor(point));
    if (!inside) voxel[found.axis] = found.positive ? found.leafMin[found.axis] : leafMax[found.axis];
    found.voxel = clamp(voxel, found.leafMin, leafMax);
    found.within = point - vec3(found.voxel);
    return found;
}

vec3 cubeRow(InstanceRecord instance, uint axis) {
    return axis == 0u ? instance.cubeFromWorld0.xyz
         : axis == 1u ? instance.cubeFromWorld1.xyz : instance.cubeFromWorld2.xyz;
}

float rayOffset(float voxelMetres, vec3 position) {
    return max(kRayOffsetVoxels * voxelMetres, 4e-7 * maxOf(abs(position)));
}

// Along the normal, and off the sides of the voxel's face as far as `margin`: in an inner edge a point that rounding has
// put a hair beyond the side lies within the solid voxel there, and all that starts in it is dark.
vec3 liftOf(InstanceRecord instance, CubeHit found, float voxelEdge, vec3 normal, float offset, float margin) {
    vec3 lift = offset * normal;
    if (found.face == kFaceInside) return lift;
    for (uint i = 1u; i < 3u; ++i) {
        uint axis = (found.axis + i) % 3u;
        vec3 row = cubeRow(instance, axis);
        float perLength = inversesqrt(dot(row, row));
        float extent = voxelEdge * perLength;
        float at = found.within[axis] * extent;  // metres from the lower side
        float limit = min(margin, 0.5 * extent);
        lift += (clamp(at, limit, extent - limit) - at) * perLength * row;
    }
    return lift;
}

// Rays start `sideMargin` metres off the sides of the face at least, and never nearer than they start off the face.
Surface surfaceOf(Scene sceneBuffer, Ray ray, Hit hit, float sideMargin) {
    SceneHeader scene = sceneBuffer.header;
    InstanceRecord instance = Instances(scene.instances).at[hit.instance];
    ModelRecord model = Models(scene.models).at[instance.model];
    CubeHit found = cubeHitOf(model, cubeFromWorldPoint(instance, ray.origin),
                              cubeFromWorldVector(instance, ray.direction), hit);
    Surface surface;
    surface.face = found.face;
    surface.voxel = model.originVoxels + found.voxel;

    vec3 row = cubeRow(instance, found.axis);
    float perLength = inversesqrt(dot(row, row));
    surface.normal = (found.positive ? -perLength : perLength) * row;
    surface.voxelMetres = edgeOf(int(model.leafScale)) * perLength;
    surface.position = ray.origin + hit.t * ray.direction;
    float offset = rayOffset(surface.voxelMetres, surface.position);
    surface.lift = liftOf(instance, found, edgeOf(int(model.leafScale)), surface.normal, offset, max(offset, sideMargin));
    surface.leafLog2 = hit.scale - int(model.leafScale);
    surface.lodColor = 0u;
    WideNode node = WideNodes(model.nodes).at[hit.node];
#ifdef PFVOX_TRACE_LOD
    if (isLevelOfDetail(model, node, hit)) {
        uvec2 lod = Lods(model.lods).at[hit.node];
        surface.lodColor = lod.x;
        surface.material = lod.y;
        return surface;
    }
#endif
    surface.material = voxelMaterial(model, node, cellAt(uvec3(found.leafMin), 0));
    return surface;
}

Surface surfaceOf(Scene scene, Ray ray, Hit hit) { return surfaceOf(scene, ray, hit, 0.0); }

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

// Where rays leave the surface.
vec3 startOf(Surface surface) { return surface.position + surface.lift; }

// Base color of what was hit, linear.
vec3 albedoOf(Scene scene, Surface surface) {
    if (surface.lodColor != 0u) return linearFromSrgb(unpackUnorm4x8(surface.lodColor).rgb);
    return Materials(scene.header.materials).at[surface.material].albedo;
}

#endif
