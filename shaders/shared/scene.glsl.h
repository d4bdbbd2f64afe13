// The scene as it lies in device memory. Written by libbake/src/scene, read by octree_trace.glsl.
//
//     SceneHeader -> BvhNode[]        over the boxes of the instances, in metres
//                 -> InstanceRecord[] in BVH order
//                 -> ModelRecord[]    -> root block: a region, or the top tree, whose leaves are regions
//                 -> MaterialRecord[] of all assets, one after the other
//
// Tree block (word offsets count from the end of its header, so that word n is node n):
//     TreeBlockHeader | nodes | lookup | values, 1 or 2 bytes each | palette | far table
// In the block of a top tree the "lookup" word of a node is the number of regions before its first leaf, and the
// "values" are the 64-bit addresses of the region blocks.
//
// Cube space: the octree cube of a model is [1, 2)^3, so that the float mantissa of a coordinate spells the path from
// the root (Laine and Karras 2010, "Efficient Sparse Voxel Octrees").
#ifndef PFVOX_SHARED_SCENE_GLSL_H
#define PFVOX_SHARED_SCENE_GLSL_H

#include "shared/types.glsl.h"

PFVOX_SHARED_BEGIN

PFVOX_CONSTANT(uint, kBvhStackSize, 40u);       // the builder never makes a deeper BVH
PFVOX_CONSTANT(uint, kOctreeStackSize, 23u);    // levels that a float mantissa can spell
PFVOX_CONSTANT(uint, kMaxTraceSteps, 1u << 16);  // for one ray in one instance; such rays are counted
PFVOX_CONSTANT(uint, kNoInstance, 0xffffffffu);
PFVOX_CONSTANT(uint, kFaceInside, 6u);          // the ray starts in the voxel; faces 0..5 = -x +x -y +y -z +z

PFVOX_STRUCT(TreeBlockHeader) {
    uint lookupOffset;   // = number of nodes
    uint valuesOffset;
    uint paletteOffset;
    uint farOffset;
    uint valueBits;      // 8 or 16; 0 in a top tree
    uint reserved0;
    uint reserved1;
    uint reserved2;
};
PFVOX_SIZE(TreeBlockHeader, 32);

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
    uint reserved0;
    uint reserved1;
};
PFVOX_SIZE(InstanceRecord, 64);
PFVOX_OFFSET(InstanceRecord, model, 48);

PFVOX_STRUCT(ModelRecord) {
    vec3 boxMin;        // tight box of the voxels, cube space
    uint depth;         // the cube has an edge of 2^depth voxels
    vec3 boxMax;
    uint regionScale;   // a leaf found at a larger scale is a region
    uvec2 rootBlock;    // address of a tree block
    uvec2 reserved0;
    ivec3 originVoxels;  // lower corner of the cube
    uint reserved1;
};
PFVOX_SIZE(ModelRecord, 64);
PFVOX_OFFSET(ModelRecord, boxMax, 16);
PFVOX_OFFSET(ModelRecord, rootBlock, 32);
PFVOX_OFFSET(ModelRecord, originVoxels, 48);

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
