// Access to a probe field in device memory (shared/probes.glsl.h): what lookup and light-field tracing have in common.
#ifndef PFVOX_PROBE_FIELD_GLSL
#define PFVOX_PROBE_FIELD_GLSL

#include "shared/probe_maths.glsl.h"
#include "shared/probes.glsl.h"

layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer ProbeFieldRef { ProbeFieldRecord field; };
layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer ProbeEntries { ProbeEntry at[]; };
layout(buffer_reference, std430, buffer_reference_align = 4) readonly buffer ProbeWords { uint at[]; };

uint probeIndexAt(ProbeFieldRecord field, ivec3 at) {
    return uint(at.x + field.counts.x * (at.y + field.counts.y * at.z));
}

// Lower corner of the eight probes around a point; of a grid that is one probe thick along an axis, that one.
ivec3 probeCellOf(ProbeFieldRecord field, vec3 point) {
    ivec3 cell = ivec3(floor(clamp((point - field.start) / field.step, vec3(-1.0), vec3(field.counts))));
    return clamp(cell, ivec3(0), max(field.counts - 2, ivec3(0)));
}

ivec3 cornerOffset(uint corner) { return ivec3(corner & 1u, corner >> 1 & 1u, corner >> 2); }

// Whether this corner of the cell is a probe of its own.
bool cornerExists(ProbeFieldRecord field, uint corner) {
    return all(lessThan(cornerOffset(corner), field.counts));
}

ProbeEntry probeAtCorner(ProbeFieldRecord field, ivec3 cell, uint corner) {
    return ProbeEntries(field.probes).at[probeIndexAt(field, cell + cornerOffset(corner))];
}

float metresOfCode(ProbeFieldRecord field, uint code) {
    return code == kDepthMiss ? 1e30 : depthOfCode(code, field.depthScaleAndLogRange.x, field.depthScaleAndLogRange.y);
}

// A bilinear read needs its texel on the other side of the map where it leaves it.
ivec2 wrappedTexel(ivec2 texel, uint resolution) {
    return borderSource(clamp(texel, ivec2(-1), ivec2(resolution)) + 1, int(resolution));
}

// First word of the proximity cell's list, or kNoProbeIndex outside the grid. `normal`: of the surface; 0 in free space.
uint proximityListOf(ProbeFieldRecord field, vec3 point, vec3 normal) {
    if (field.cellCounts.x == 0) return kNoProbeIndex;
    vec3 at = proximityCoordinate(point, normal, field.cellStart, field.cellStep);
    if (any(lessThan(at, vec3(0.0))) || any(greaterThanEqual(at, vec3(field.cellCounts)))) return kNoProbeIndex;
    ivec3 cell = ivec3(at);
    return kProbesOfCell * uint(cell.x + field.cellCounts.x * (cell.y + field.cellCounts.y * cell.z));
}

#endif
