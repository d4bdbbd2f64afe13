// What bench_trace measures (bench/trace_bench.cpp).
#ifndef PFVOX_SHARED_BENCH_GLSL_H
#define PFVOX_SHARED_BENCH_GLSL_H

#include "shared/types.glsl.h"

PFVOX_SHARED_BEGIN

PFVOX_CONSTANT(uint, kBenchGroupSize, 128u);  // four tiles of 8 x 4 pixels

PFVOX_CONSTANT(uint, kBenchPrimary, 0u);
PFVOX_CONSTANT(uint, kBenchShadow, 1u);
PFVOX_CONSTANT(uint, kBenchDiffuse, 2u);
PFVOX_CONSTANT(uint, kBenchOrigins, 3u);  // not timed: where the secondary rays start
PFVOX_CONSTANT(uint, kBenchReset, 4u);    // of the counters

PFVOX_CONSTANT(uint, kBenchGeometry, 0u);  // one model, no instances, no materials
PFVOX_CONSTANT(uint, kBenchScene, 1u);

PFVOX_CONSTANT(uint, kBenchUseNormal, 7u);  // instead of a face

PFVOX_STRUCT(BenchParameters) {
    uvec2 scene;
    uvec2 origins;   // vec4: where a secondary ray starts; bits of w: face | index << 3
    uvec2 normals;   // vec4: where a ray's face is kBenchUseNormal
    uvec2 results;   // of a shadow ray one word, else two: voxel x | y << 12 | z << 24, then
                     // z >> 8 | face << 4 | 1 << 8 | material << 12; 0 = miss
    uvec2 counters;
    uint width;      // pixels
    uint height;
    vec3 eye;        // metres
    uint rayCount;
    vec3 forward;
    uint bounces;    // of diffuse rays, at least 1
    vec3 right;      // length tan(fovX / 2)
    uint batch;      // persistent: steps between looks for idle lanes
    vec3 up;
    uint refill;     // persistent: idle lanes that are worth a refill
};
PFVOX_SIZE(BenchParameters, 112);
PFVOX_OFFSET(BenchParameters, eye, 48);

PFVOX_STRUCT(BenchCounters) {
    uint next;   // persistent: the first ray that nobody has taken
    uint hits;
    uint stepLimitReached;
    uint reserved0;
    uint steps;
    uint rays;   // casts, bounces counted one by one
    uint reserved1;
    uint reserved2;
};
PFVOX_SIZE(BenchCounters, 32);

PFVOX_SHARED_END
#endif
