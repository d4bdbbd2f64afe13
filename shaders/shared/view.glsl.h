// What a picture is made from: read by view_scene.comp, written by viewer/picture.cpp.
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
    uint reserved0;
    vec3 skyHorizon;
    uint reserved1;
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
};
PFVOX_SIZE(ViewPushConstants, 32);

PFVOX_SHARED_END
#endif
