// Rays through a probe field instead of the scene: the probes around the origin one after the other, each by traceProbe of
// probe_walk.glsl. Where a ray goes behind what one sees, another goes on.
#ifndef PFVOX_PROBE_TRACE_GLSL
#define PFVOX_PROBE_TRACE_GLSL

#include "probe_walk.glsl"

const uint kMaxFieldRestarts = 16u;
const uint kMaxNamedProbes = 32u;
const float kProgressVoxels = 0.1;  // what makes asking the same probes again worth while

uint nearestCorner(ProbeFieldRecord field, ivec3 cell, vec3 point) {
    uint best = 0u;
    float bestSquared = 1e30;
    for (uint corner = 0u; corner < 8u; ++corner) {
        if (!cornerExists(field, corner)) continue;
        ProbeEntry probe = probeAtCorner(field, cell, corner);
        vec3 apart = probe.position - point;
        if (probe.isActive == 0u || dot(apart, apart) >= bestSquared) continue;
        best = corner;
        bestSquared = dot(apart, apart);
    }
    return best;
}

// The eight probes around a point, nearest first, then with a stride of 3, which meets far ones early and all of them.
uint traceCell(ProbeFieldRecord field, ivec3 cell, FieldRay ray, inout float tMin, inout FieldHit hit,
               inout FieldStatistics statistics) {
    uint corner = nearestCorner(field, cell, ray.origin + tMin * ray.direction);
    for (uint i = 0u; i < 8u; ++i, corner = (corner + 3u) & 7u) {
        if (!cornerExists(field, corner)) continue;
        ProbeEntry probe = probeAtCorner(field, cell, corner);
        if (probe.isActive == 0u) continue;
        uint state = traceProbe(field, probe, ray, tMin, hit, statistics);
        hit.probe = probeIndexAt(field, cell + cornerOffset(corner));
        if (state != kFieldUnknown) return state;
    }
    return kFieldUnknown;
}

// The next other cell along the ray, from a time on; false when there is none any more. The time moves there.
bool nextFieldCell(ProbeFieldRecord field, FieldRay ray, inout float t, inout ivec3 cell) {
    float pace = 0.5 * min(field.step.x, min(field.step.y, field.step.z));
    float end = min(ray.tMax, length(field.step * vec3(field.counts)));
    for (; t < end; t += pace) {
        ivec3 at = probeCellOf(field, ray.origin + t * ray.direction);
        if (at == cell) continue;
        cell = at;
        return true;
    }
    return false;
}

// What the probes around do not see, those that the proximity grid names for the places along the ray may: they see the
// surfaces there.
uint traceNamedProbes(ProbeFieldRecord field, FieldRay ray, inout float tMin, inout FieldHit hit,
                      inout FieldStatistics statistics) {
    if (field.cellCounts.x == 0) return kFieldUnknown;
    float pace = 0.5 * min(field.cellStep.x, min(field.cellStep.y, field.cellStep.z));
    float end = min(ray.tMax, length(field.step * vec3(field.counts)));
    uint last = kNoProbeIndex;
    uint asked = 0u;
    for (float t = tMin; t < end && asked < kMaxNamedProbes; t += pace) {
        uint list = proximityListOf(field, ray.origin + t * ray.direction, vec3(0.0));
        if (list == kNoProbeIndex || list == last) continue;
        last = list;
        for (uint k = 0u; k < kProbesOfCell; ++k) {
            uint index = ProbeWords(field.cells).at[list + k];
            if (index == kNoProbeIndex) break;
            ++asked;
            uint state = traceProbe(field, ProbeEntries(field.probes).at[index], ray, tMin, hit, statistics);
            hit.probe = index;
            if (state != kFieldUnknown) return state;
        }
        t = max(t, tMin);
    }
    return kFieldUnknown;
}

// Of fields with depth maps. tMax may be anything up to infinity: beyond Far no probe knows anything. When the probes
// around the origin do not know, those further along the ray may.
FieldHit traceField(ProbeFieldRecord field, FieldRay ray, inout FieldStatistics statistics) {
    FieldHit hit = FieldHit(kFieldUnknown, 0.0, vec3(0.0), kNoProbeIndex, 0u);
    ray.tMax = min(ray.tMax, 4.0 * field.farMetres);
    float tMin = 0.0;
    float tCell = 0.0;
    ivec3 cell = probeCellOf(field, ray.origin);
    for (uint restart = 0u; restart <= kMaxFieldRestarts; ++restart) {
        float before = tMin;
        hit.state = traceCell(field, cell, ray, tMin, hit, statistics);
        if (hit.state != kFieldUnknown) break;
        tCell = max(tCell, tMin);
        // A probe behind whose sight the ray went may see it again where another has seen it come out.
        if (tMin > before + kProgressVoxels * field.voxelMetres) {
            cell = probeCellOf(field, ray.origin + tMin * ray.direction);
            continue;
        }
        if (!nextFieldCell(field, ray, tCell, cell)) break;
    }
    if (hit.state == kFieldUnknown) hit.state = traceNamedProbes(field, ray, tMin, hit, statistics);
    if (hit.state != kFieldHit) hit.t = hit.state == kFieldMiss ? ray.tMax : tMin;
    return hit;
}

// The same; what no probe could decide is answered by the nearest probe's view in the direction of the ray.
FieldHit traceFieldFilled(ProbeFieldRecord field, FieldRay ray, inout FieldStatistics statistics) {
    FieldHit hit = traceField(field, ray, statistics);
    if (hit.state != kFieldUnknown) return hit;
    ivec3 cell = probeCellOf(field, ray.origin);
    uint corner = nearestCorner(field, cell, ray.origin);
    ProbeEntry probe = probeAtCorner(field, cell, corner);
    if (probe.isActive == 0u) return hit;
    uint texel = texelIndex(ray.direction, field.depthResolution);
    uint word = ProbeWords(probe.depthNormal).at[texel];
    if (isMiss(word)) return hit;
    float depth = metresOfCode(field, depthCodeOf(word));
    hit.state = kFieldFilled;
    hit.t = max(dot(probe.position + depth * ray.direction - ray.origin, ray.direction), 0.0);
    hit.normal = normalOf(word);
    hit.probe = probeIndexAt(field, cell + cornerOffset(corner));
    hit.texel = texel;
    return hit;
}

// I at the surface that a trace found.
vec3 lightOfHit(ProbeFieldRecord field, FieldHit hit) {
    if (hit.state != kFieldHit && hit.state != kFieldFilled || field.lightResolution == 0u) return vec3(0.0);
    ProbeEntry probe = ProbeEntries(field.probes).at[hit.probe];
    uint block = max(field.depthResolution / field.lightResolution, 1u);
    uint x = min(hit.texel % field.depthResolution / block, field.lightResolution - 1u);
    uint y = min(hit.texel / field.depthResolution / block, field.lightResolution - 1u);
    return unpackLight(ProbeWords(probe.light).at[x + field.lightResolution * y]);
}

#endif
