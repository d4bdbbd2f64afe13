// What a picture is made from: read by the view_*.comp programs, written by the viewer.
//
//     light:       geometry -> SeenPixel -> sun -> ambient -> reflections -> light -> color, once for each sample of a pixel
//     inspection:  scene, field or atlas -> color
//     then         colors -> resolve -> pixels
#ifndef PFVOX_SHARED_VIEW_GLSL_H
#define PFVOX_SHARED_VIEW_GLSL_H

#include "shared/types.glsl.h"

PFVOX_SHARED_BEGIN

PFVOX_CONSTANT(uint, kViewGroupEdge, 8u);

PFVOX_CONSTANT(uint, kViewFinal, 0u);
PFVOX_CONSTANT(uint, kViewAlbedo, 1u);
PFVOX_CONSTANT(uint, kViewNormals, 2u);
PFVOX_CONSTANT(uint, kViewMaterial, 3u);
PFVOX_CONSTANT(uint, kViewDepth, 4u);
PFVOX_CONSTANT(uint, kViewSteps, 5u);
PFVOX_CONSTANT(uint, kViewLod, 6u);
PFVOX_CONSTANT(uint, kViewIndirect, 7u);
PFVOX_CONSTANT(uint, kViewTiers, 8u);
PFVOX_CONSTANT(uint, kViewField, 9u);
PFVOX_CONSTANT(uint, kViewFieldDifference, 10u);
PFVOX_CONSTANT(uint, kViewAtlasLight, 11u);
PFVOX_CONSTANT(uint, kViewAtlasNormals, 12u);
PFVOX_CONSTANT(uint, kViewAtlasDepth, 13u);
PFVOX_CONSTANT(uint, kViewModeCount, 14u);

PFVOX_STRUCT(ViewParameters) {
    vec3 cameraPosition;  // metres
    uint width;           // pixels
    vec3 cameraForward;   // unit length
    uint height;
    vec3 cameraRight;     // length tan(fovX / 2)
    uint samplesPerPixel;
    vec3 cameraUp;        // length tan(fovY / 2)
    uint mode;            // kView...
    vec3 sunDirection;    // where the light travels, unit length
    float exposure;       // factor on radiance
    vec3 sunIrradiance;   // linear RGB at normal incidence
    float stepScale;      // steps at the hot end of the heat map
    vec3 skyZenith;       // radiance, linear RGB
    float cone;           // of a camera ray (Ray::cone); 0 = levels of detail are not used
    vec3 skyHorizon;
    uint firstSample;     // of the sequence of positions within a pixel
    vec3 skyGround;
    uint toneMap;         // kToneMap...
    uvec2 field;          // ProbeFieldRecord; 0 = there are no probes
    uint atlasFirst;      // probe in the upper left
    uint atlasCount;      // probes shown
    uint atlasColumns;
    uint atlasCell;       // edge of one map, pixels, with a gap of one
    uint ambientRays;     // of each sample, where no probes give the indirect light
    float ambientReach;   // metres; what is farther away does not hide the sky
    vec3 groundMiddle;    // metres
    float groundRadius;   // 0 = there is no ground
    uvec2 emitters;       // EmitterFace[]
    uint emitterCount;
    float emitterPower;   // as in BakeScene
    uvec2 faces;          // FaceField; 0 = there is no light on faces
    uint reserved0;
    uint reserved1;
};
PFVOX_SIZE(ViewParameters, 224);
PFVOX_OFFSET(ViewParameters, cameraUp, 48);
PFVOX_OFFSET(ViewParameters, sunIrradiance, 80);
PFVOX_OFFSET(ViewParameters, skyGround, 128);
PFVOX_OFFSET(ViewParameters, field, 144);
PFVOX_OFFSET(ViewParameters, emitters, 192);

PFVOX_CONSTANT(uint, kToneMapStandard, 0u);
PFVOX_CONSTANT(uint, kToneMapLinear, 1u);
PFVOX_CONSTANT(uint, kToneMapReinhard, 2u);
PFVOX_CONSTANT(uint, kToneMapAces, 3u);
PFVOX_CONSTANT(uint, kToneMapNeutral, 4u);

// SeenPixel::material of the ground: no material of the scene.
PFVOX_CONSTANT(uint, kGroundMaterial, 0xfffffffeu);

// What a camera ray sees behind all glass.
PFVOX_STRUCT(SeenPixel) {
    float distance;  // metres; 1e30 = sky
    uint material;
    uint normal;     // octahedral, two snorm16
    uint lodColor;   // sRGB of a level of detail; 0 = the material's
    uint cell;       // of what was hit, a voxel or a level of detail: see packCell
    uint sun;        // fraction of the sun that arrives, R11G11B10F
    uint through;    // fraction that glass in front lets through, R11G11B10F
    uint ambient;    // I of its face or as rays guess it, RGB9E5; where probes do not say it
};
PFVOX_SIZE(SeenPixel, 32);

// Of scenes with glass or mirrors only: the first glass in front, and what reflections add.
PFVOX_STRUCT(SeenShine) {
    vec3 added;         // radiance at the camera
    float distance;     // of the glass; 1e30 = none
    uint material;
    uint normal;        // as in SeenPixel
    uint cell;          // as in SeenPixel
    uint ambient;       // as in SeenPixel
};
PFVOX_SIZE(SeenShine, 32);

// Sums over all samples of all frames, 64 bits each: low word first.
PFVOX_CONSTANT(uint, kCountHits, 0u);        // camera rays that met a voxel
PFVOX_CONSTANT(uint, kCountSteps, 1u);
PFVOX_CONSTANT(uint, kCountStepLimit, 2u);
PFVOX_CONSTANT(uint, kCountSunRays, 3u);
PFVOX_CONSTANT(uint, kCountReflectionRays, 4u);
PFVOX_CONSTANT(uint, kCountWithoutValue, 5u);  // lookups without a tier, or not finite
PFVOX_CONSTANT(uint, kCountTiers, 6u);         // six, by kTier...
PFVOX_CONSTANT(uint, kCountFieldStates, 12u);  // three, by kField...
PFVOX_CONSTANT(uint, kCountFieldAgrees, 15u);  // the octree says the same
PFVOX_CONSTANT(uint, kCountAmbientRays, 16u);
PFVOX_CONSTANT(uint, kViewCounterCount, 17u);

PFVOX_STRUCT(ViewPushConstants) {
    uvec2 scene;
    uvec2 parameters;
    uvec2 colors;   // vec4 each: display color before the encoding, distance; mean of the samples so far
    uvec2 counters;  // uvec2[kViewCounterCount]
    uvec2 seen;      // SeenPixel each
    uvec2 shine;     // SeenShine each; 0 = the scene needs none
    uint sampleIndex;
    uint firstRow;   // of the rows that the buffers hold
    uint rowCount;
    uint reserved0;
};
PFVOX_SIZE(ViewPushConstants, 64);

// Frames that follow one another become one picture: view_resolve.comp.
PFVOX_STRUCT(ResolveParameters) {
    vec3 position;      // the camera as in ViewParameters
    uint width;
    vec3 forward;
    uint height;
    vec3 right;
    uint moved;         // 0: the camera of the frame before was the same
    vec3 up;
    uint frameLimit;    // of which a moving picture is the mean
    vec3 lastPosition;  // the camera of the frame before
    uint hasHistory;    // 0: there is no frame before
    vec3 lastForward;
    uint reserved0;
    vec3 lastRight;
    uint reserved1;
    vec3 lastUp;
    uint reserved2;
};
PFVOX_SIZE(ResolveParameters, 128);
PFVOX_OFFSET(ResolveParameters, lastPosition, 64);

PFVOX_STRUCT(ResolvePushConstants) {
    uvec2 parameters;
    uvec2 frame;        // vec4 each: color, distance
    uvec2 lastFrame;
    uvec2 history;      // vec4 each: color, number of frames in it; written unless 0
    uvec2 lastHistory;
    uvec2 pixels;       // one RGBA8 word each; written
};
PFVOX_SIZE(ResolvePushConstants, 48);

PFVOX_SHARED_END
#endif
