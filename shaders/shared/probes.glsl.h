// A probe field as it lies in device memory. Written by libbake/src/lookup, read by probe_lookup.glsl and
// probe_trace.glsl.
//
//     ProbeFieldRecord -> ProbeEntry[] by index, x + nx * (y + ny * z)  -> the maps of one probe
//                      -> uint[4] for each cell of the proximity grid: probes, best first, kNoProbe at the end
//
// Maps have the words of the file (docs/format-pf_probe.md); min maps hold two codes a word, the first in the low half.
// World space, metres.
#ifndef PFVOX_SHARED_PROBES_GLSL_H
#define PFVOX_SHARED_PROBES_GLSL_H

#include "shared/types.glsl.h"

PFVOX_SHARED_BEGIN

PFVOX_CONSTANT(uint, kNoProbeIndex, 0xffffffffu);
PFVOX_CONSTANT(uint, kProbesOfCell, 4u);

PFVOX_STRUCT(ProbeEntry) {
    vec3 position;
    uint isActive;  // 0: has no maps, and nothing reads it
    uvec2 depthNormal;
    uvec2 light;
    uvec2 minDepth;
    uvec2 irradiance;
    uvec2 moments;
    uint nearestActive;  // itself when active; kNoProbeIndex when there is none
    uint reserved0;
};
PFVOX_SIZE(ProbeEntry, 64);
PFVOX_OFFSET(ProbeEntry, depthNormal, 16);
PFVOX_OFFSET(ProbeEntry, nearestActive, 56);

PFVOX_STRUCT(ProbeFieldRecord) {
    vec3 start;  // grid point of probe 0
    uint depthResolution;
    vec3 step;
    uint lightResolution;
    ivec3 counts;
    uint irradianceResolution;  // interior
    vec3 cellStart;       // proximity grid
    uint momentsResolution;     // interior
    vec3 cellStep;
    float momentRange;
    ivec3 cellCounts;     // 0 = no proximity grid
    float voxelMetres;
    vec2 depthScaleAndLogRange;
    uvec2 probes;
    uvec2 cells;
    float farMetres;
    uint reserved0;
};
PFVOX_SIZE(ProbeFieldRecord, 128);
PFVOX_OFFSET(ProbeFieldRecord, counts, 32);
PFVOX_OFFSET(ProbeFieldRecord, cellCounts, 80);
PFVOX_OFFSET(ProbeFieldRecord, depthScaleAndLogRange, 96);
PFVOX_OFFSET(ProbeFieldRecord, farMetres, 120);

// ---- Which step of the lookup gave a value ----

PFVOX_CONSTANT(uint, kTierNone, 0u);     // no active probe at all
PFVOX_CONSTANT(uint, kTierTexels, 1u);   // texels that see the point
PFVOX_CONSTANT(uint, kTierTraced, 2u);   // light-field trace: secondary rays only
PFVOX_CONSTANT(uint, kTierCompact, 3u);  // irradiance of the eight probes around
PFVOX_CONSTANT(uint, kTierFaces, 5u);    // the face itself (shared/faces.glsl.h)
PFVOX_CONSTANT(uint, kTierNearest, 4u);  // irradiance of the nearest active probe

// ---- Light-field tracing ----

PFVOX_CONSTANT(uint, kFieldMiss, 0u);     // certain: a probe saw past the whole ray
PFVOX_CONSTANT(uint, kFieldHit, 1u);
PFVOX_CONSTANT(uint, kFieldUnknown, 2u);  // the ray goes behind what the probes see
PFVOX_CONSTANT(uint, kFieldFilled, 3u);   // unknown, answered by the nearest probe's view in that direction

// ---- Batches of queries (probe_query.comp) ----

PFVOX_CONSTANT(uint, kProbeQueryGroupSize, 64u);
PFVOX_CONSTANT(uint, kQueryLookup, 0u);
PFVOX_CONSTANT(uint, kQueryTrace, 1u);
PFVOX_CONSTANT(uint, kQueryTraceHighOnly, 2u);  // without the min maps: for tests
PFVOX_CONSTANT(uint, kQueryTraceFilled, 3u);

PFVOX_STRUCT(ProbeQueryRecord) {
    vec3 position;  // surface point, or origin of a ray
    float tMax;
    vec3 direction;  // normal of the surface, or direction of the ray; unit
    uint reserved0;
};
PFVOX_SIZE(ProbeQueryRecord, 32);

PFVOX_STRUCT(ProbeAnswerRecord) {
    vec3 light;   // I; of a trace that hits: at the surface
    float t;
    vec3 normal;
    uint state;   // kTier... or kField...
    vec4 weights;  // of tiers 1, 3 and 4
    uint probe;
    uint lowSteps;
    uint highSteps;
    uint probesAndCaps;  // probes asked, and caps << 16
};
PFVOX_SIZE(ProbeAnswerRecord, 64);
PFVOX_OFFSET(ProbeAnswerRecord, weights, 32);

PFVOX_STRUCT(ProbeQueryParameters) {
    uvec2 field;
    uvec2 queries;
    uvec2 answers;
    uint count;
    uint mode;
};
PFVOX_SIZE(ProbeQueryParameters, 32);

PFVOX_SHARED_END
#endif
