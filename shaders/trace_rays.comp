// A batch of rays in, a batch of hits out (shared/rays.glsl.h).
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

#include "shared/rays.glsl.h"
#define PFVOX_TRACE_GROUP_SIZE kTraceRaysGroupSize
#define PFVOX_TRACE_LOD
#include "octree_trace.glsl"

layout(local_size_x = kTraceRaysGroupSize) in;

layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer Rays { RayRecord at[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) writeonly buffer Hits { HitRecord at[]; };
layout(push_constant) uniform Parameters { TraceRaysParameters parameters; };

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= parameters.rayCount) return;
    RayRecord record = Rays(parameters.rays).at[index];
    Scene scene = Scene(parameters.scene);
    Ray ray = Ray(record.origin, record.tMax, record.direction, record.cone);
    bool anyHit = parameters.mode == kTraceAnyHit;

    TraceStatistics statistics = TraceStatistics(0u, 0u);
    Hit hit = traceScene(scene, ray, anyHit, statistics);
    HitRecord result = HitRecord(ivec3(0), hit.t, vec3(0.0), kNoInstance, 0u, 0u, statistics.steps,
                                 statistics.stepLimitReached, 0u, 0, 0u, 0u);
    if (hit.instance != kNoInstance) {
        result.instance = Instances(scene.header.instances).at[hit.instance].id;
        if (!anyHit) {
            Surface surface = surfaceOf(scene, ray, hit);
            result.voxel = surface.voxel;
            result.normal = surface.normal;
            result.material = surface.material;
            result.face = surface.face;
            result.lodColor = surface.lodColor;
            result.cellLog2 = surface.leafLog2;
        }
    }
    Hits(parameters.hits).at[index] = result;
}
