// The scene as it lies in device memory. Written by libbake/src/scene, read by octree_trace.glsl.
//
//     SceneHeader -> BvhNode[]        over the boxes of the instances, in metres
//                 -> InstanceRecord[] in BVH order
//                 -> ModelRecord[]    -> WideNode[], values, palettes, levels of detail of one model
//                 -> MaterialRecord[] of all assets, one after the other
//
// A model's octree is read two levels at a time (docs/decisions/012-wide-tree.md): a wide node has 4^3 cells, cell
// k = x + 4y + 16z. Node 0 is the root; the inner cells' nodes follow one another in the order of k.
//
// Cube space: the root is [1, 2)^3, so that the float mantissa of a coordinate spells the path from the root (Laine and
// Karras 2010, "Efficient Sparse Voxel Octrees").
#ifndef PFVOX_SHARED_SCENE_GLSL_H
#define PFVOX_SHARED_SCENE_GLSL_H

#include "shared/types.glsl.h"

PFVOX_SHARED_BEGIN

PFVOX_CONSTANT(uint, kBvhStackSize, 40u);       // the builder never makes a deeper BVH
PFVOX_CONSTANT(uint, kMaxWideLevels, 11u);      // two bits each: what a float mantissa can spell
PFVOX_CONSTANT(uint, kMaxTraceSteps, 1u << 16);  // for one ray in one instance; such rays are counted
PFVOX_CONSTANT(uint, kNoInstance, 0xffffffffu);
PFVOX_CONSTANT(float, kRayOffsetVoxels, 0.01f);  // how far rays start off the surface that they leave
PFVOX_CONSTANT(uint, kFaceInside, 6u);          // the ray starts in the voxel; faces 0..5 = -x +x -y +y -z +z

// WideNode::kind, bits 0 and 1. All but inner ones have leaves for cells.
PFVOX_CONSTANT(uint, kWideKindMask, 3u);
PFVOX_CONSTANT(uint, kWideInner, 0u);     // child: node of the first cell
PFVOX_CONSTANT(uint, kWideBrick, 1u);     // 4^3 voxels; child: value of the first set cell
PFVOX_CONSTANT(uint, kWideUniform, 2u);   // 4^3 voxels of one material; child: that material of the scene
PFVOX_CONSTANT(uint, kWideSolid, 3u);     // one leaf; child: its material of the scene
PFVOX_CONSTANT(uint, kWideShortValues, 4u);  // a brick's values have 2 bytes, not 1
PFVOX_CONSTANT(uint, kWidePaletteShift, 3u);  // kind >> 3 of a brick: where its palette begins

PFVOX_STRUCT(WideNode) {
    uint maskLow;   // bit k: cell k is not empty
    uint maskHigh;  // cells 32 to 63
    uint child;
    uint kind;
};
PFVOX_SIZE(WideNode, 16);

PFVOX_STRUCT(BvhNode) {
    vec3 boxMin;
    uint first;  // leaf: first instance record; else: left child, the right one follows it
    vec3 boxMax;
    uint count;  // instances of a leaf; 0 = inner node
};
PFVOX_SIZE(BvhNode, 32);
PFVOX_OFFSET(BvhNode, boxMax, 16);

PFVOX_STRUCT(InstanceRecord) {
    vec4 cubeFromWorld0;  // rows of the 3x4 matrix
    vec4 cubeFromWorld1;
    vec4 cubeFromWorld2;
    uint model;
    uint id;  // position in the list of all instances of the scene, hidden ones counted
    uint firstFace;  // number of its first value (shared/faces.glsl.h)
    uint firstMean;  // and of its first mean
};
PFVOX_SIZE(InstanceRecord, 64);
PFVOX_OFFSET(InstanceRecord, model, 48);

PFVOX_STRUCT(ModelRecord) {
    vec3 boxMin;         // tight box of the voxels, cube space
    uint leafScale;      // cells of voxel size have an edge of 2^(leafScale - 23) cubes
    vec3 boxMax;
    uint reserved0;
    uvec2 nodes;         // WideNode[]
    uvec2 values;        // palette indices, 1 or 2 bytes each
    uvec2 palettes;      // one word an entry: material of the scene
    uvec2 lods;          // LodRecord[], beside the nodes; 0 = none
    ivec3 originVoxels;  // lower corner of the cube
    uint reserved1;
    uvec2 faceCells;     // uvec2[], beside the nodes (shared/faces.glsl.h); 0 = faces were not asked for
    uvec2 faceSlots;     // uvec2[]: masks
};
PFVOX_SIZE(ModelRecord, 96);
PFVOX_OFFSET(ModelRecord, boxMax, 16);
PFVOX_OFFSET(ModelRecord, nodes, 32);
PFVOX_OFFSET(ModelRecord, originVoxels, 64);

PFVOX_STRUCT(MaterialRecord) {
    vec3 albedo;             // linear
    float emissionStrength;  // radiance = albedo x strength
    uint type;               // pfvox::MaterialType
    float metalness;
    float roughness;
    float specular;
    float indexOfRefraction;
    float transparency;
    float alpha;
    uint reserved0;
};
PFVOX_SIZE(MaterialRecord, 48);
PFVOX_OFFSET(MaterialRecord, type, 16);

PFVOX_STRUCT(SceneHeader) {
    uvec2 bvhNodes;
    uvec2 instances;
    uvec2 models;
    uvec2 materials;
    uint instanceCount;  // 0: nothing to hit, and no BVH
    uint bvhNodeCount;
    uint modelCount;
    uint materialCount;
};
PFVOX_SIZE(SceneHeader, 48);
PFVOX_OFFSET(SceneHeader, instanceCount, 32);

PFVOX_SHARED_END
#endif
