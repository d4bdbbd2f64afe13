// Which faces need more than one value: those that see a lamp nearby, those where light bends more than a bilinear lookup
// follows, and bars, stairs and rims, which have no neighbors to look between. Two launches: how far light bends at each
// face (into the goals, which nobody needs then), and levels.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

#include "face_bake.glsl"

// Voxels to a lamp, and second differences over the light, from which on a face has 2, 4, 8 values each way. A bilinear lookup
// is off by an eighth of a second difference.
const float kLampVoxels[3] = float[3](8.0, 4.0, 2.0);
const float kBending[2] = float[2](0.16, 0.32);
const uint kMostBendingLevels = 2u;  // of foliage every face bends
const float kDarkness = 4.0;     // times the floor of the noise: what is darker may bend more
const float kDeviations = 5.0;  // of noise that do not count as bending: noise alone bends by 3.5, on average

struct Neighbors {
    uint at[4];  // in the list of all: -u, +u, -v, +v
};

Neighbors neighborsOf(FaceBake faces, Scene scene, FaceRecord record) {
    uint face = record.instanceAndFace & 7u;
    InstanceRecord instance = Instances(scene.header.instances).at[record.instanceAndFace >> 3];
    ModelRecord model = Models(scene.header.models).at[instance.model];
    ivec3 voxel = ivec3(record.x, record.y, record.z);
    FaceLeaf own;
    findLeaf(model, voxel, own);
    Neighbors found;
    for (uint i = 0u; i < 4u; ++i) {
        ivec3 other = voxel;
        other[((face >> 1) + 1u + (i >> 1)) % 3u] += (i & 1u) != 0u ? 1 : -1;
        FaceLeaf leaf = own;
        bool there = sameLeaf(model, own, voxel, other) || findLeaf(model, other, leaf);
        uint number = there ? faceNumber(model, leaf, uvec3(other), face) : kNoFace;
        found.at[i] = number == kNoFace ? kNoFace : instance.firstFace + number;
        if (found.at[i] != kNoFace && FaceVectors(faces.sums).at[found.at[i]].w <= 0.0) found.at[i] = kNoFace;
    }
    return found;
}

// Mean channel of I, and the variance of that.
vec2 lightAndVariance(FaceBake faces, uint face) {
    vec4 parts = FaceVectors(faces.quarters).at[face] * (4.0 / max(FaceVectors(faces.sums).at[face].w, 1.0));
    float mean = dot(parts, vec4(0.25));
    vec4 off = parts - mean;
    return vec2(mean, dot(off, off) / 12.0);
}

float bendingAt(FaceBake faces, uint face, Neighbors beside) {
    vec2 own = lightAndVariance(faces, face);
    float bending = 0.0;
    float variance = own.y;  // four parts of a face's rays say little: of all faces that are asked
    float asked = 1.0;
    for (uint axis = 0u; axis < 2u; ++axis) {
        uint a = beside.at[2u * axis];
        uint b = beside.at[2u * axis + 1u];
        if (a == kNoFace && b == kNoFace) continue;
        vec2 lower = a == kNoFace ? lightAndVariance(faces, b) : lightAndVariance(faces, a);
        vec2 upper = b == kNoFace ? lower : lightAndVariance(faces, b);
        // From one side alone a difference may be a slope, which the lookup follows.
        float across = abs(lower.x + upper.x - 2.0 * own.x);
        bending += a == kNoFace || b == kNoFace ? 0.5 * across : across;
        variance += lower.y + upper.y;
        asked += 2.0;
    }
    return (bending - kDeviations * sqrt(variance / asked)) / max(own.x, kDarkness * faces.noiseFloor);
}

void main() {
    FaceBake faces = FaceBakes(push.bake).bake;
    Scene scene = Scene(BakeScenes(faces.scene).at[0].scene);
    uint face = push.first + faceGroup() * kFaceGroupSize + gl_LocalInvocationIndex;
    if (face >= push.first + push.count) return;
    FaceRecord record = FaceRecords(faces.faces).at[face];
    Neighbors beside = neighborsOf(faces, scene, record);
    if (push.source == 0u) {
        FaceWords(faces.goals).at[face] = floatBitsToUint(bendingAt(faces, face, beside));
        return;
    }
    float bending = uintBitsToFloat(FaceWords(faces.goals).at[face]);
    float lamp = FaceVectors(faces.sun).at[face].w;
    bool single = false;
    for (uint axis = 0u; axis < 2u; ++axis)
        single = single || (beside.at[2u * axis] == kNoFace && beside.at[2u * axis + 1u] == kNoFace);
    for (uint i = 0u; i < 4u; ++i) {
        if (beside.at[i] == kNoFace) continue;
        bending = max(bending, 0.5 * uintBitsToFloat(FaceWords(faces.goals).at[beside.at[i]]));
    }
    uint level = single ? 1u : 0u;
    for (uint i = 0u; i < kMaxFaceLevel; ++i) {
        bool bends = i < kMostBendingLevels && bending > kBending[i];
        if (lamp <= kLampVoxels[i] || bends) level = max(level, i + 1u);
    }
    FaceWords(faces.levels).at[face] = FaceVectors(faces.sums).at[face].w > 0.0 ? level : 0u;
}
