// E / pi of the sun on each face, from shadow rays spread evenly over it.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

#include "face_bake.glsl"

void main() {
    FaceBake faces = FaceBakes(push.bake).bake;
    BakeScene bake = BakeScenes(faces.scene).at[0];
    uint slot = gl_LocalInvocationIndex / kFaceLanes;
    uint lane = gl_LocalInvocationIndex % kFaceLanes;
    uint place = faceGroup() * kFaceGroupValues + slot;
    uint face = push.first + place;
    RayCounts counts = RayCounts(0u, TraceStatistics(0u, 0u));
    vec4 mine = vec4(0.0);
    if (place < push.count && lane < kFaceSunRays) {
        FacePlane plane = planeOf(faces, Scene(bake.scene), FaceRecords(faces.faces).at[face]);
        if (hasSun(bake, plane.normal)) {
            vec3 from = pointOf(plane, FacePart(face, 0u, 0u), (vec2(lane % 4u, lane / 4u) + 0.5) / 4.0);
            float cosine = dot(plane.normal, -bake.sunDirection);
            mine.rgb = sunAt(bake, from, counts) * cosine / (kPi * float(kFaceSunRays));
        }
    }
    vec4 sum = sumOfLanes(mine);
    if (place < push.count) addRays(faces, counts);
    if (place < push.count && lane == 0u) {
        FaceVectors(faces.sun).at[face] = vec4(sum.rgb, kInfinity);
        FaceVectors(faces.light[0]).at[face] = vec4(0.0);
    }
}
