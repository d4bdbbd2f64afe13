// Batches of rays for trace_rays.comp: tests, benchmarks and picking.
#ifndef PFVOX_SHARED_RAYS_GLSL_H
#define PFVOX_SHARED_RAYS_GLSL_H

#include "shared/types.glsl.h"

PFVOX_SHARED_BEGIN

PFVOX_CONSTANT(uint, kTraceRaysGroupSize, 64u);
PFVOX_CONSTANT(uint, kTraceClosestHit, 0u);
PFVOX_CONSTANT(uint, kTraceAnyHit, 1u);

PFVOX_STRUCT(RayRecord) {
    vec3 origin;     // metres
    float tMax;      // in lengths of the direction
    vec3 direction;  // any length but zero
    float cone;      // width in parts of the distance; 0 = every voxel counts
};
PFVOX_SIZE(RayRecord, 32);

PFVOX_STRUCT(HitRecord) {
    ivec3 voxel;    // in voxels of the model
    float t;        // in lengths of the direction
    vec3 normal;    // in the world, unit length
    uint instance;  // InstanceRecord::id, kNoInstance = miss; an any-hit ray sets nothing but this
    uint material;  // of the scene
    uint face;      // in the model; kFaceInside when the ray starts in the voxel
    uint steps;     // iterations of the octree loop, all instances
    uint stepLimitReached;    // 1: an instance was given up after kMaxTraceSteps
    uint lodColor;  // of a level of detail: R, G, B (sRGB), coverage; else 0
    int cellLog2;   // edge of the cell that was hit = 2^cellLog2 voxels
    uint reserved0;
    uint reserved1;
};
PFVOX_SIZE(HitRecord, 64);
PFVOX_OFFSET(HitRecord, normal, 16);
PFVOX_OFFSET(HitRecord, material, 32);

PFVOX_STRUCT(TraceRaysParameters) {
    uvec2 scene;
    uvec2 rays;
    uvec2 hits;
    uint rayCount;
    uint mode;
};
PFVOX_SIZE(TraceRaysParameters, 32);

PFVOX_SHARED_END
#endif
