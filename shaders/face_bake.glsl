// What the programs that bake faces have in common (shared/faces.glsl.h): where things lie, points of faces, sums.
#ifndef PFVOX_FACE_BAKE_GLSL
#define PFVOX_FACE_BAKE_GLSL

#include "shared/faces.glsl.h"
#include "shared/sampling.glsl.h"
#define PFVOX_TRACE_GROUP_SIZE kFaceGroupSize
#include "emitters.glsl"
#include "face_index.glsl"

layout(local_size_x = kFaceGroupSize) in;

layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer FaceBakes { FaceBake bake; };
layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer FaceFrames { FaceFrame at[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer FaceRecords { FaceRecord at[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) buffer FaceVectors { vec4 at[]; };
layout(buffer_reference, std430, buffer_reference_align = 8) buffer FaceLinks { uvec2 at[]; };
layout(buffer_reference, std430, buffer_reference_align = 4) buffer FaceWords { uint at[]; };
layout(buffer_reference, std430, buffer_reference_align = 4) buffer FaceFloats { float at[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) buffer FaceControls { FaceControl control; };
layout(push_constant) uniform Push { FacePush push; };

uint faceGroup() { return gl_WorkGroupID.y * kFaceRowGroups + gl_WorkGroupID.x; }

// A face or a part of one.
struct FacePart {
    uint face;
    uint level;
    uint part;  // u before v
};

FacePart partOfValue(FaceBake bake, uint value) {
    if ((bake.parts.x | bake.parts.y) == 0u) return FacePart(value, 0u, 0u);
    uvec2 stored = FaceLinks(bake.parts).at[value];
    return FacePart(stored.x, stored.y >> 8, stored.y & 255u);
}

// Where rays of a face start.
struct FacePlane {
    vec3 corner;  // metres, off the face along its normal
    vec3 edgeU;
    vec3 edgeV;
    vec3 normal;
    float margin;       // fraction of the edges that rays keep off the sides
    float voxelMetres;  // the longer edge
};

FacePlane planeOf(FaceBake bake, Scene scene, FaceRecord record) {
    uint face = record.instanceAndFace & 7u;
    uint index = record.instanceAndFace >> 3;
    FaceFrame frame = FaceFrames(bake.frames).at[index];
    InstanceRecord instance = Instances(scene.header.instances).at[index];
    ModelRecord model = Models(scene.header.models).at[instance.model];
    uint axis = face >> 1;
    uvec3 voxel = uvec3(record.x, record.y, record.z);
    if ((face & 1u) != 0u) ++voxel[axis];
    vec3 edges[3] = vec3[3](frame.edgeX.xyz, frame.edgeY.xyz, frame.edgeZ.xyz);
    FacePlane plane;
    plane.edgeU = edges[(axis + 1u) % 3u];
    plane.edgeV = edges[(axis + 2u) % 3u];
    vec3 row = cubeRow(instance, axis);
    float perLength = inversesqrt(dot(row, row));
    plane.normal = ((face & 1u) != 0u ? perLength : -perLength) * row;
    vec3 corner = frame.corner.xyz + float(voxel.x) * edges[0] + float(voxel.y) * edges[1] + float(voxel.z) * edges[2];
    float offset = rayOffset(edgeOf(int(model.leafScale)) * perLength, corner);
    plane.corner = corner + offset * plane.normal;
    float shorter = min(length(plane.edgeU), length(plane.edgeV));
    plane.voxelMetres = max(length(plane.edgeU), length(plane.edgeV));
    plane.margin = min(offset / shorter, 0.25);
    return plane;
}

vec3 pointOf(FacePlane plane, FacePart part, vec2 within) {
    uint edge = 1u << part.level;
    vec2 at = (vec2(part.part & (edge - 1u), part.part >> part.level) + within) / float(edge);
    at = clamp(at, vec2(plane.margin), vec2(1.0 - plane.margin));
    return plane.corner + at.x * plane.edgeU + at.y * plane.edgeV;
}

// ---- Sums over the invocations of a value, pairwise: the same order however many work side by side ----

shared vec4 laneSums[kFaceGroupSize];

// All invocations call it; the first one of each value has the sum.
vec4 sumOfLanes(vec4 mine) {
    uint index = gl_LocalInvocationIndex;
    uint lane = index % kFaceLanes;
    laneSums[index] = mine;
    for (uint width = kFaceLanes / 2u; width > 0u; width /= 2u) {
        barrier();
        vec4 other = lane < width ? laneSums[index + width] : vec4(0.0);
        barrier();
        if (lane < width) laneSums[index] += other;
    }
    vec4 sum = laneSums[index];
    barrier();
    return sum;
}

void addRays(FaceBake bake, RayCounts counts) {
    if (counts.rays != 0u) {
        uint before = atomicAdd(FaceControls(bake.control).control.raysLow, counts.rays);
        if (before + counts.rays < before) atomicAdd(FaceControls(bake.control).control.raysHigh, 1u);
    }
    if (counts.trace.stepLimitReached != 0u) atomicAdd(FaceControls(bake.control).control.stepLimitRays, 1u);
}

#endif
