// Light on the faces of voxels as it lies in device memory (docs/format-pf_probe.md has the file).
//
//     InstanceRecord.firstFace, ModelRecord.faces -> FaceCell of a wide node -> mask -> number of the face
//
// A model's index is shared by its instances. Beside each wide node lies a FaceCell; beside that of a brick, for each
// direction that has exposed faces, a mask of the voxels whose face that is, cell k = x + 4y + 16z. Faces are counted
// brick by brick, in a brick by direction, of a direction by cell:
//
//     value = instance.firstFace + cell.first + bits of the directions before + bits below the cell
//
// Large leaves are kept by the bricks of their sides: see FaceCell. What stands for a node in levels of detail is one
// mean for each of its directions, beside the masks.
#ifndef PFVOX_SHARED_FACES_GLSL_H
#define PFVOX_SHARED_FACES_GLSL_H

#include "shared/types.glsl.h"

#ifdef __cplusplus
#include <cmath>
#endif

PFVOX_SHARED_BEGIN

// A FaceCell is a uvec2. x: which of the six directions have exposed faces (bit d = face d), and << 6 where the first one's
// mask lies; y: number of its first face in the model. An inner node has a slot for each direction, too, for its means; a
// solid leaf of more than 4^3 voxels has for each direction (edge / 4)^2 slots, the lower axis first: x of the slot is the
// mask of the 4 x 4 faces of a square, cell a + 4b, y the number of its first face, from that of the leaf.
PFVOX_CONSTANT(uint, kFaceDirections, 63u);
PFVOX_CONSTANT(uint, kFaceSlotShift, 6u);

// A value is RGB9E5, red in the low bits. The exponent 31 says that it is something else: a face with r x r values of its
// own, r = 2^level, or none.
PFVOX_CONSTANT(uint, kFaceEscape, 31u << 27);
PFVOX_CONSTANT(uint, kFaceLevelShift, 25u);        // level 1 to 3; 0 = no value: another instance covers the face
PFVOX_CONSTANT(uint, kFacePartMask, (1u << 25) - 1u);  // where its values begin, in fours
PFVOX_CONSTANT(uint, kFaceNoValue, 31u << 27);
PFVOX_CONSTANT(uint, kMaxFaceLevel, 3u);
PFVOX_CONSTANT(float, kMaxFaceLight, 32704.0f);    // 511/512 x 2^15: the largest value below the escape

// Round to nearest (Ward's shared exponent; EXT_texture_shared_exponent describes the word).
PFVOX_FUNCTION uint packRgb9e5(vec3 c) {
#ifdef __cplusplus
    using std::exp2;
    using std::floor;
    using glm::clamp;
    using glm::max;
#endif
    c = clamp(c, vec3(0.0f), vec3(kMaxFaceLight));
    float largest = max(c.x, max(c.y, c.z));
    // Below 2^-16 all is 0.
    int exponent = 0;
#ifdef __cplusplus
    if (largest > 0.0f) exponent = glm::clamp(std::ilogb(largest) + 16, 0, 30);
#else
    if (largest > 0.0) exponent = clamp(int((floatBitsToUint(largest) >> 23)) - 127 + 16, 0, 30);
#endif
    float scale = exp2(float(24 - exponent));
    // What rounds up to the next power takes the next exponent.
    if (floor(largest * scale + 0.5f) == 512.0f) {
        exponent += 1;
        scale *= 0.5f;
    }
    uint r = uint(floor(c.x * scale + 0.5f));
    uint g = uint(floor(c.y * scale + 0.5f));
    uint b = uint(floor(c.z * scale + 0.5f));
    return r | g << 9 | b << 18 | uint(exponent) << 27;
}
PFVOX_FUNCTION vec3 unpackRgb9e5(uint word) {
#ifdef __cplusplus
    using std::exp2;
#endif
    float scale = exp2(float(word >> 27) - 24.0f);
    return scale * vec3(float(word & 511u), float(word >> 9 & 511u), float(word >> 18 & 511u));
}

// Values of a scene.
PFVOX_STRUCT(FaceField) {
    uvec2 values;  // uint[] by face
    uvec2 parts;   // uint[]: of divided faces, each row by row
    uvec2 means;   // uint[]: beside the slots of a model, once an instance
    uint reserved0;
    uint reserved1;
};
PFVOX_SIZE(FaceField, 32);

// --- The bake of faces (libbake/src/faces) ---
//
//     face_sun      sun that a face has, on average over it
//     face_gather   rays from faces: as links, that keep what they met, or as the final light of values
//     face_sweep    light of all faces once more around, through the links
//     face_noise    which values need more rays
//     face_divide   which faces need more values
//
// A value is a face, or a part of one that is divided. 32 invocations work on a value; what they find is added up in
// an order that does not depend on how the work is cut into launches.

PFVOX_CONSTANT(uint, kFaceGroupSize, 64u);
PFVOX_CONSTANT(uint, kFaceLanes, 32u);        // invocations that work on one value
PFVOX_CONSTANT(uint, kFaceGroupValues, 2u);   // of a workgroup
PFVOX_CONSTANT(uint, kFaceBatchRays, 128u);   // of a value, summed before anything else is added
PFVOX_CONSTANT(uint, kFaceSunRays, 16u);
PFVOX_CONSTANT(uint, kFaceRowGroups, 32768u);  // workgroups along x of a launch of more than one row
PFVOX_CONSTANT(uint, kNoFace, 0xffffffffu);

// Where the voxels of an instance lie in the frame of the device: corner + x, y, z times the edges.
PFVOX_STRUCT(FaceFrame) {
    vec4 edgeX;  // metres
    vec4 edgeY;
    vec4 edgeZ;
    vec4 corner;  // of the model's cube
};
PFVOX_SIZE(FaceFrame, 64);

PFVOX_STRUCT(FaceRecord) {
    uint x;  // voxel, from the corner of the model's cube
    uint y;
    uint z;
    uint instanceAndFace;  // record of the instance << 3
};
PFVOX_SIZE(FaceRecord, 16);

PFVOX_STRUCT(FaceBake) {
    uvec2 scene;     // BakeScene
    uvec2 frames;    // FaceFrame[] by instance record
    uvec2 faces;     // FaceRecord[]
    uvec2 sun;       // vec4[] by face: E / pi of the sun; w: voxels to the nearest lamp that it sees
    uvec2 direct;    // vec4[] by face: light that its links did not meet on a face; w: 1 / rays that count
    uvec2 light[2];  // vec4[] by face: E / pi, sun and all; one is read, the other one written
    uvec2 links;     // uvec2[linkCount] by face: face that was met, RGB9E5 of what comes of its light
    uvec2 parts;     // uvec2[] by value: face, level << 8 | part; 0 = values are faces
    uvec2 sums;      // vec4[] by value: of I; w: rays that count
    uvec2 quarters;  // vec4[] by value: sums of the mean channel over four parts of the rays
    uvec2 goals;     // uint[] by value: batches that it is to have
    uvec2 clusters;  // uint[] first value of each, and the end
    uvec2 noise;     // float[] by cluster: relative standard error
    uvec2 levels;    // uint[] by face
    uvec2 control;   // FaceControl
    uint linkCount;  // rays of a face, a multiple of kFaceBatchRays
    uint faceCount;
    float noiseTarget;
    float noiseFloor;  // of a cluster's mean
    uint maxSteps;     // metal and glass that a ray goes on by
    uint reserved0;
};
PFVOX_SIZE(FaceBake, 160);
PFVOX_OFFSET(FaceBake, linkCount, 128);

PFVOX_STRUCT(FaceControl) {
    uint raysLow;
    uint raysHigh;
    uint stepLimitRays;
    uint largestChange;  // bits of a float: of the last sweep, relative
    uint unfinished;     // clusters that go on
    uint reserved0;
    uint reserved1;
    uint reserved2;
};
PFVOX_SIZE(FaceControl, 32);

PFVOX_STRUCT(FacePush) {
    uvec2 bake;
    uint first;       // value, face or cluster
    uint count;
    uint firstBatch;
    uint batchEnd;
    uint source;      // light that is read
    uint reserved0;
};
PFVOX_SIZE(FacePush, 32);

PFVOX_SHARED_END
#endif
