// What the baker's programs read and write: bake_geometry.comp and bake_light.comp, driven by libbake/src/bake.
#ifndef PFVOX_SHARED_BAKE_GLSL_H
#define PFVOX_SHARED_BAKE_GLSL_H

#include "shared/types.glsl.h"

PFVOX_SHARED_BEGIN

PFVOX_CONSTANT(uint, kBakeGroupSize, 64u);
PFVOX_CONSTANT(uint, kTileEdge, 8u);         // a workgroup of bake_light is a tile of texels
PFVOX_CONSTANT(uint, kTileTexels, 64u);
PFVOX_CONSTANT(uint, kBatchSamples, 16u);    // paths that one invocation sums up
PFVOX_CONSTANT(uint, kMaxBlockEdge, 4u);     // texels of the depth map along one of the light map, at most
PFVOX_CONSTANT(uint, kRouletteBounce, 3u);   // the first bounce that roulette may end
PFVOX_CONSTANT(uint, kMaxPathBounces, 128u);  // 0.95^128 of the light is left then, at most
PFVOX_CONSTANT(uint, kMaxGlassSteps, 64u);   // voxels of glass on one straight line
PFVOX_CONSTANT(float, kRayOffsetVoxels, 0.01f);

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
    vec3 normal;   // world, unit length
    float metres;  // along the texel's direction, < 0 = nothing
    vec3 direct;   // radiance that leaves towards the probe without indirect light; of a miss, the sky's
    uint word;     // of ProbeLayer::DepthNormal
    vec3 albedo;
    float offset;  // metres that a ray from here starts off the surface
};
PFVOX_SIZE(SeenTexel, 48);

PFVOX_STRUCT(GeometryPush) {
    uvec2 scene;    // BakeScene
    uvec2 texels;   // SeenTexel[edge^2]
    vec3 probe;     // metres
    uint edge;
    float depthScale;
    float depthLogRange;
    uint firstTexel;
    uint texelCount;
    uvec2 counters;  // BakeCounters
    uvec2 reserved0;
};
PFVOX_SIZE(GeometryPush, 64);

PFVOX_STRUCT(LightPush) {
    uvec2 scene;
    uvec2 texels;
    vec3 probe;
    uint depthEdge;
    uvec2 items;     // uvec2[]: tile, first sample; one a workgroup
    uvec2 sums;      // vec4[kTileTexels] for each of them: radiance of kBatchSamples paths; w: bits of the rays cast
    uint lightEdge;
    uint probeIndex;  // in the grid
    uvec2 counters;
};
PFVOX_SIZE(LightPush, 64);

PFVOX_STRUCT(BakeCounters) {
    uint cappedRays;
    uint reserved0;
    uint reserved1;
    uint reserved2;
};
PFVOX_SIZE(BakeCounters, 16);

PFVOX_SHARED_END
#endif
