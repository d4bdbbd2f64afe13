// What a picture is made from: read by view_scene.comp and view_resolve.comp, written by the viewer.
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
    uint reserved2;
};
PFVOX_SIZE(ViewParameters, 144);
PFVOX_OFFSET(ViewParameters, cameraUp, 48);
PFVOX_OFFSET(ViewParameters, sunIrradiance, 80);
PFVOX_OFFSET(ViewParameters, skyGround, 128);

PFVOX_STRUCT(ViewCounters) {
    uint primaryHits;
    uint cappedRays;
    uint stepsLow;  // 64-bit sum over all rays of all samples
    uint stepsHigh;
    uint raysLow;
    uint raysHigh;
    uint reserved0;
    uint reserved1;
};
PFVOX_SIZE(ViewCounters, 32);

PFVOX_STRUCT(ViewPushConstants) {
    uvec2 scene;
    uvec2 parameters;
    uvec2 pixels;  // one RGBA8 word each, rows from the top
    uvec2 counters;
    uvec2 linear;  // vec4 each: colour before the encoding, distance; 0 = write `pixels` instead
    uvec2 reserved0;
};
PFVOX_SIZE(ViewPushConstants, 48);

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
    uvec2 frame;        // vec4 each: colour, distance; from view_scene.comp
    uvec2 lastFrame;
    uvec2 history;      // vec4 each: colour, number of frames in it; written
    uvec2 lastHistory;
    uvec2 pixels;       // one RGBA8 word each; written
};
PFVOX_SIZE(ResolvePushConstants, 48);

PFVOX_SHARED_END
#endif
