// What the baker's programs read and write, driven by libbake/src/bake (docs/decisions/015-wavefront.md):
//
//     bake_geometry                what the probes of a group see
//     bake_tiles                   noise of each tile of texels; the CPU lists the work of the next round by it
//     bake_begin                   a wave of paths, 16 for each texel of each item of work
//     bake_cast, bake_scatter,     one vertex further: closest hits, light and new directions,
//     bake_queue, bake_cast ...    how much is left, shadow rays to the sun and to emitters; until no path is left
//     bake_gather                  sums of the paths of each texel, in their order
//     bake_finish                  the maps of the group
#ifndef PFVOX_SHARED_BAKE_GLSL_H
#define PFVOX_SHARED_BAKE_GLSL_H

#include "shared/types.glsl.h"

PFVOX_SHARED_BEGIN

PFVOX_CONSTANT(uint, kBakeGroupSize, 64u);
PFVOX_CONSTANT(uint, kBakeRowGroups, 32768u);  // workgroups along x of a launch of more than one row
PFVOX_CONSTANT(uint, kTileEdge, 8u);
PFVOX_CONSTANT(uint, kTileTexels, 64u);
PFVOX_CONSTANT(uint, kBatchSamples, 16u);    // paths that are summed before anything else is added
PFVOX_CONSTANT(uint, kItemPaths, 1024u);     // kTileTexels x kBatchSamples
PFVOX_CONSTANT(uint, kMaxBlockEdge, 4u);     // texels of the depth map along one of the light map, at most
PFVOX_CONSTANT(uint, kRouletteBounce, 3u);   // the first bounce that roulette may end
PFVOX_CONSTANT(uint, kMaxPathBounces, 128u);  // 0.95^128 of the light is left then, at most
PFVOX_CONSTANT(uint, kMaxGlassSteps, 64u);   // bodies of glass that a path goes through or is reflected by

// LightSampling
PFVOX_CONSTANT(uint, kSampleCombined, 0u);
PFVOX_CONSTANT(uint, kSampleEmitters, 1u);
PFVOX_CONSTANT(uint, kSampleDirections, 2u);

// An exposed face of an emissive voxel, in the world, and its entry in the alias table.
PFVOX_STRUCT(EmitterFace) {
    vec3 corner;     // metres
    float threshold;  // of the alias table: this face below it, `alias` above
    vec3 edgeU;      // metres; cross(edgeU, edgeV) points outward
    uint alias;
    vec3 edgeV;
    float offset;    // metres that a shadow ray ends before the face, along its normal
    vec3 radiance;
    float reserved;
};
PFVOX_SIZE(EmitterFace, 64);

PFVOX_STRUCT(BakeScene) {
    uvec2 scene;        // SceneHeader
    uvec2 emitters;     // EmitterFace[]
    uint emitterCount;
    float emitterPower;  // sum of area x mean radiance: what a face is picked by
    uint maxBounces;
    uint sampling;
    vec3 sunDirection;  // where the light travels, unit length
    uint seedLow;
    vec3 sunIrradiance;
    uint seedHigh;
    vec3 skyZenith;
    uint reserved0;
    vec3 skyHorizon;
    uint reserved1;
    vec3 skyGround;
    uint reserved2;
};
PFVOX_SIZE(BakeScene, 112);
PFVOX_OFFSET(BakeScene, sunDirection, 32);

// What a texel of the traced depth map sees.
PFVOX_STRUCT(SeenTexel) {
    vec3 lift;     // from the surface to where its rays start, metres
    float metres;  // along the texel's direction, < 0 = nothing
    vec3 direct;   // radiance that leaves towards the probe without indirect light; of a miss, the sky's
    uint word;     // of ProbeLayer::DepthNormal
    vec3 albedo;
    uint normal;   // octahedral, two snorm16
};
PFVOX_SIZE(SeenTexel, 48);

// --- A group of probes ---

PFVOX_STRUCT(BakeProbe) {
    vec3 position;  // metres
    uint index;     // in the grid
};
PFVOX_SIZE(BakeProbe, 16);

// Of one tile of the light map, after `batches` batches.
PFVOX_STRUCT(TileStatistics) {
    float mean;           // sum over its texels of the mean channel of I
    float squaredError;   // sum over its texels of the squared standard error of that
    uint surfaceTexels;   // those that see a surface
    uint batches;
};
PFVOX_SIZE(TileStatistics, 16);

// --- A wave of paths ---

// Path i is sample (i / 64) % 16 of texel i % 64 of the tile and batch of item i / 1024.
PFVOX_STRUCT(PathState) {
    vec3 origin;      // of its ray
    float pdf;    // of the ray's direction, per steradian; < 0: no emitter sampling could have found it
    vec3 direction;
    float travelled;  // metres since the last vertex that scattered
    vec3 throughput;
    uint steps;       // vertices behind the texel's; << 16: steps through glass
    uint lastGlass;   // the body that the ray is in
    uint key;         // of its random numbers
    uint sampleIndex;
    uint reserved;
};
PFVOX_SIZE(PathState, 64);

PFVOX_STRUCT(PathHit) {
    vec3 corner;
    float t;
    uint instance;
    uint node;
    uint scale;
    uint axis;
};
PFVOX_SIZE(PathHit, 32);

PFVOX_STRUCT(ShadowRay) {
    vec3 origin;
    float metres;
    vec3 direction;
    uint path;
    vec3 light;  // that arrives if nothing is in between
    float reserved;
};
PFVOX_SIZE(ShadowRay, 48);

// Consecutive items of one tile.
PFVOX_STRUCT(GatherRun) {
    uint firstItem;
    uint itemCount;
    uint tile;       // of the group
    uint reserved;
};
PFVOX_SIZE(GatherRun, 16);

// What waits: rays of paths, shadow rays to the sun, shadow rays to emitters.
PFVOX_CONSTANT(uint, kQueueRays, 0u);
PFVOX_CONSTANT(uint, kQueueSun, 1u);
PFVOX_CONSTANT(uint, kQueueEmitters, 2u);
PFVOX_CONSTANT(uint, kQueueKinds, 4u);

PFVOX_STRUCT(WaveControl) {
    uint waiting[8];    // by set (0, 1) and queue: kQueueKinds x set + queue
    uint launch[12];    // four by queue: workgroups along x, y, z of a launch that covers it
    uint raysLow;       // cast since the bake began
    uint raysHigh;
    uint stepLimitRays;    // given up by the traversal
    uint reserved;
};
PFVOX_SIZE(WaveControl, 96);
PFVOX_OFFSET(WaveControl, launch, 32);
PFVOX_OFFSET(WaveControl, raysLow, 80);

// All that the programs work on.
PFVOX_STRUCT(BakeWave) {
    uvec2 scene;        // BakeScene
    uvec2 probes;       // BakeProbe[] of the group
    uvec2 texels;       // SeenTexel[depthResolution^2] of each probe
    uvec2 sums;         // vec4[lightResolution^2] of each probe: radiance of its paths; w: Welford's sum of squares of its batches
    uvec2 tiles;        // TileStatistics[] of each probe
    uvec2 items;        // uvec2[]: tile of the group, batch
    uvec2 runs;         // GatherRun[]
    uvec2 paths;        // PathState[]
    uvec2 arrived;      // vec4[]: radiance that each path has brought so far
    uvec2 hits;         // PathHit[], beside the queue
    uvec2 rays[2];      // uint[] by set: paths whose ray waits
    uvec2 shadowRays[2];  // ShadowRay[]: to the sun, to emitters
    uvec2 control;      // WaveControl
    uvec2 maps;         // by probe, see bake_finish.comp
    uint depthResolution;
    uint lightResolution;
    float depthScale;   // of DepthCoder
    float depthLogRange;
};
PFVOX_SIZE(BakeWave, 144);
PFVOX_OFFSET(BakeWave, depthResolution, 128);

PFVOX_STRUCT(WavePush) {
    uvec2 wave;   // BakeWave
    uint first;   // what the launch covers: texels, tiles, items or runs
    uint count;
    uint set;     // of the queues: read from here, and written to the other one
    uint reserved0;
    uvec2 faces;  // FaceField, where light is taken from faces
};
PFVOX_SIZE(WavePush, 32);

PFVOX_SHARED_END
#endif
