// Light of all faces once more around: sun and direct light, and what the links bring of the light of other faces.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

#include "face_bake.glsl"

void main() {
    FaceBake faces = FaceBakes(push.bake).bake;
    uint slot = gl_LocalInvocationIndex / kFaceLanes;
    uint lane = gl_LocalInvocationIndex % kFaceLanes;
    uint place = faceGroup() * kFaceGroupValues + slot;
    uint face = push.first + place;
    vec4 mine = vec4(0.0);
    if (place < push.count) {
        for (uint i = lane; i < faces.linkCount; i += kFaceLanes) {
            uvec2 link = FaceLinks(faces.links).at[face * faces.linkCount + i];
            if (link.x != kNoFace)
                mine.rgb += unpackRgb9e5(link.y) * FaceVectors(faces.light[push.source]).at[link.x].rgb;
        }
    }
    vec4 sum = sumOfLanes(mine);
    if (place >= push.count || lane != 0u) return;
    vec4 direct = FaceVectors(faces.direct).at[face];
    vec3 before = FaceVectors(faces.light[push.source]).at[face].rgb;
    vec3 after = FaceVectors(faces.sun).at[face].rgb + direct.rgb + direct.w * sum.rgb;
    FaceVectors(faces.light[1u - push.source]).at[face] = vec4(after, 0.0);
    // Not negative: its bits are in the order of the values.
    float change = abs(meanOf(after) - meanOf(before)) / max(meanOf(after), faces.noiseFloor);
    atomicMax(FaceControls(faces.control).control.largestChange, floatBitsToUint(change));
}
