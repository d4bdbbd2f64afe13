// From a voxel's face to its number in the list of all faces (shared/faces.glsl.h). Expects octree_trace.glsl.
#ifndef PFVOX_FACE_INDEX_GLSL
#define PFVOX_FACE_INDEX_GLSL

#include "shared/faces.glsl.h"

layout(buffer_reference, std430, buffer_reference_align = 8) readonly buffer FacePairs { uvec2 at[]; };

// A brick or a large leaf, and where it lies.
struct FaceLeaf {
    uint node;
    int scale;  // of its edge
};

int brickScale(ModelRecord model) { return int(model.leafScale) + 2; }

FaceLeaf leafOf(ModelRecord model, Hit hit) { return FaceLeaf(hit.node, max(hit.scale, brickScale(model))); }

uint bitsBelow(uvec2 mask, uint cell) {
    uint half_ = cell < 32u ? mask.x : mask.y;
    return bitCount(half_ & ((1u << (cell & 31u)) - 1u)) + (cell < 32u ? 0u : bitCount(mask.x));
}

// Number of the face of a voxel in the model, kNoFace where it is not exposed. `voxel` counts from the cube's corner.
uint faceNumber(ModelRecord model, FaceLeaf leaf, uvec3 voxel, uint face) {
    uvec2 cell = FacePairs(model.faceCells).at[leaf.node];
    if ((cell.x >> face & 1u) == 0u) return kNoFace;
    uint before = bitCount(cell.x & ((1u << face) - 1u));
    uint slot = cell.x >> kFaceSlotShift;
    if (leaf.scale == brickScale(model)) {
        uint first = cell.y;
        for (uint i = 0u; i < before; ++i) {
            uvec2 mask = FacePairs(model.faceSlots).at[slot + i];
            first += bitCount(mask.x) + bitCount(mask.y);
        }
        uvec2 mask = FacePairs(model.faceSlots).at[slot + before];
        uint k = cellAt(voxel, 0);
        if (((k < 32u ? mask.x : mask.y) >> (k & 31u) & 1u) == 0u) return kNoFace;
        return first + bitsBelow(mask, k);
    }
    int edgeLog2 = leaf.scale - brickScale(model);  // bricks
    uvec3 brick = voxel >> 2 & ((1u << edgeLog2) - 1u);
    uvec2 a = face < 2u ? uvec2(brick.y, voxel.y) : uvec2(brick.x, voxel.x);
    uvec2 b = face >= 4u ? uvec2(brick.y, voxel.y) : uvec2(brick.z, voxel.z);
    uvec2 square = FacePairs(model.faceSlots).at[slot + (before << 2 * edgeLog2) + a.x + (b.x << edgeLog2)];
    uint k = (a.y & 3u) + 4u * (b.y & 3u);
    if ((square.x >> k & 1u) == 0u) return kNoFace;
    return cell.y + square.y + bitCount(square.x & ((1u << k) - 1u));
}

// The brick or large leaf that holds a voxel. False where there is none.
bool findLeaf(ModelRecord model, ivec3 voxel, out FaceLeaf leaf) {
    int levels = (kCubeScale - int(model.leafScale)) / 2;
    leaf = FaceLeaf(0u, kCubeScale);
    if (any(lessThan(voxel, ivec3(0))) || any(greaterThanEqual(voxel, ivec3(1 << 2 * levels)))) return false;
    uvec3 position = uvec3(voxel) << model.leafScale;
    for (int i = 0; i < levels; ++i) {
        WideNode node = WideNodes(model.nodes).at[leaf.node];
        if (kindOf(node) != kWideInner) return true;
        int scale = leaf.scale - 2;
        uint cell = cellAt(position, scale);
        if ((maskHalf(node, cell) >> (cell & 31u) & 1u) == 0u) return false;
        leaf = FaceLeaf(node.child + cellsBefore(node, cell), scale);
    }
    return true;
}

// Whether a voxel lies in a leaf as another one that does.
bool sameLeaf(ModelRecord model, FaceLeaf leaf, ivec3 voxel, ivec3 other) {
    return (voxel >> (leaf.scale - int(model.leafScale))) == (other >> (leaf.scale - int(model.leafScale)));
}

// A ray that comes out of glass begins within the voxel behind it. The face that it came through is the exposed one that it looks
// against most.
void faceFromInside(ModelRecord model, FaceLeaf leaf, vec3 direction, inout CubeHit found) {
    vec3 against = abs(direction);
    for (uint i = 0u; i < 3u; ++i) {
        uint axis = against.x >= maxOf(against) ? 0u : against.y >= against.z ? 1u : 2u;
        uint face = 2u * axis + (direction[axis] > 0.0 ? 0u : 1u);
        if (faceNumber(model, leaf, uvec3(found.voxel), face) != kNoFace) {
            found.axis = axis;
            found.face = face;
            found.within = clamp(found.within, 0.0, 1.0);
            return;
        }
        against[axis] = -1.0;
    }
}

// Number of the face that a ray has hit, in the list of all; kNoFace where it is none.
uint faceOfHit(Scene sceneBuffer, Ray ray, Hit hit) {
    SceneHeader scene = sceneBuffer.header;
    InstanceRecord instance = Instances(scene.instances).at[hit.instance];
    ModelRecord model = Models(scene.models).at[instance.model];
    CubeHit found = cubeHitOf(model, cubeFromWorldPoint(instance, ray.origin), cubeFromWorldVector(instance, ray.direction),
                              hit);
    if (found.face == kFaceInside)
        faceFromInside(model, leafOf(model, hit), cubeFromWorldVector(instance, ray.direction), found);
    if (found.face == kFaceInside) return kNoFace;
    uint number = faceNumber(model, leafOf(model, hit), uvec3(found.voxel), found.face);
    return number == kNoFace ? kNoFace : instance.firstFace + number;
}

#endif
