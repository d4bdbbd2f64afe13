// Which values need more rays: the noise of a cluster of neighbors, from the spread of four parts of their rays.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

#include "face_bake.glsl"

void main() {
    FaceBake faces = FaceBakes(push.bake).bake;
    uint cluster = push.first + faceGroup() * kFaceGroupSize + gl_LocalInvocationIndex;
    if (cluster >= push.first + push.count) return;
    uint first = FaceWords(faces.clusters).at[cluster];
    uint end = FaceWords(faces.clusters).at[cluster + 1u];
    if (FaceWords(faces.goals).at[first] < push.firstBatch) return;  // has enough
    float squares = 0.0;
    float mean = 0.0;
    float count = 0.0;
    for (uint value = first; value < end; ++value) {
        vec4 sum = FaceVectors(faces.sums).at[value];
        if (sum.w <= 0.0) continue;
        vec4 parts = FaceVectors(faces.quarters).at[value] * (4.0 / sum.w);
        float middle = dot(parts, vec4(0.25));
        vec4 off = parts - middle;
        squares += dot(off, off) / 12.0;
        mean += middle;
        count += 1.0;
    }
    float noise = count > 0.0 ? sqrt(squares / count) / max(mean / count, faces.noiseFloor) : 0.0;
    FaceFloats(faces.noise).at[cluster] = noise;
    if (noise > faces.noiseTarget) {
        for (uint value = first; value < end; ++value) FaceWords(faces.goals).at[value] = push.source;  // of the next round
        atomicAdd(FaceControls(faces.control).control.unfinished, 1u);
    }
}
