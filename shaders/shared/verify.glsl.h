// What verify_probes.comp reads and writes; driven by libbake/src/verify.
#ifndef PFVOX_SHARED_VERIFY_GLSL_H
#define PFVOX_SHARED_VERIFY_GLSL_H

#include "shared/types.glsl.h"

PFVOX_SHARED_BEGIN

PFVOX_CONSTANT(uint, kVerifyGroupEdge, 8u);

PFVOX_STRUCT(VerifyPixel) {
    vec4 lookup;  // I; w: tier, -1 where the camera sees no surface
    vec4 even;    // sums of the reference's I over samples of even and of odd number; w: how many
    vec4 odd;
    uint material;  // pfvox::MaterialType of the surface
    uint reserved0;
    uint reserved1;
    uint reserved2;
};
PFVOX_SIZE(VerifyPixel, 64);

PFVOX_STRUCT(VerifyView) {
    vec3 position;  // metres
    uint width;
    vec3 forward;   // unit length
    uint height;
    vec3 right;     // length tan(fovX / 2)
    uint reserved0;
    vec3 up;        // length tan(fovY / 2)
    uint reserved1;
};
PFVOX_SIZE(VerifyView, 64);

PFVOX_STRUCT(VerifyPush) {
    uvec2 scene;   // BakeScene
    uvec2 field;   // ProbeFieldRecord
    uvec2 view;
    uvec2 pixels;  // VerifyPixel[]
    uvec2 faces;   // FaceField; 0 = look up probes
    uint firstSample;
    uint sampleCount;  // 0: the lookup only
    uint firstRow;
    uint reserved0;
    uint reserved1;
    uint reserved2;
};
PFVOX_SIZE(VerifyPush, 64);

PFVOX_SHARED_END
#endif
