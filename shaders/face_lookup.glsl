// Light on the face that a ray has hit: the one lookup of viewer, baker and verify (shared/faces.glsl.h). Expects
// octree_trace.glsl.
//
// Between the middles of values light is bilinear; across a rim, where a face has no neighbor on one side, the slope from the
// other side goes on, as far as half of the value. Values of neighbors are taken where the lattice of the face's own values
// goes on, however many values they have. Of a level of detail, the mean of its faces in that direction.
#ifndef PFVOX_FACE_LOOKUP_GLSL
#define PFVOX_FACE_LOOKUP_GLSL

#include "face_index.glsl"

layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer FaceFields { FaceField field; };
layout(buffer_reference, std430, buffer_reference_align = 4) readonly buffer FaceValues { uint at[]; };

struct FaceLight {
    vec3 indirect;  // I
    bool known;
};
const FaceLight kNoFaceLight = FaceLight(vec3(0.0), false);

bool isEscape(uint word) { return word >> 27 == 31u; }

// Of the value at a place (0 to 1) on a face; `word` is the face's.
FaceLight valueAt(FaceField field, uint word, vec2 at) {
    if (!isEscape(word)) return FaceLight(unpackRgb9e5(word), true);
    uint level = word >> kFaceLevelShift & 3u;
    if (level == 0u) return kNoFaceLight;
    float edge = float(1u << level);
    uvec2 part = uvec2(clamp(at * edge, vec2(0.0), vec2(edge - 1.0)));
    uint index = 4u * (word & kFacePartMask) + part.x + (part.y << level);
    return FaceLight(unpackRgb9e5(FaceValues(field.parts).at[index]), true);
}

// A face and where it lies.
struct FacePlace {
    ModelRecord model;
    uint firstFace;  // of the instance
    FaceLeaf leaf;
    ivec3 voxel;  // from the cube's corner
    uint face;
};

// The value of the face's lattice that is `lattice` from its first one, on the face itself or on a neighbor.
FaceLight latticeValue(FaceField field, FacePlace place, uint word, float edge, vec2 lattice) {
    vec2 at = (lattice + 0.5) / edge;
    ivec2 step = ivec2(floor(at));
    if (step == ivec2(0)) return valueAt(field, word, at);
    ivec3 voxel = place.voxel;
    uint axis = place.face >> 1;
    voxel[(axis + 1u) % 3u] += step.x;
    voxel[(axis + 2u) % 3u] += step.y;
    FaceLeaf leaf = place.leaf;
    if (!sameLeaf(place.model, leaf, place.voxel, voxel) && !findLeaf(place.model, voxel, leaf)) return kNoFaceLight;
    uint number = faceNumber(place.model, leaf, uvec3(voxel), place.face);
    if (number == kNoFace) return kNoFaceLight;
    return valueAt(field, FaceValues(field.values).at[place.firstFace + number], at - vec2(step));
}

// `at`: where on the face, 0 to 1 along the axes behind its own.
FaceLight faceLightAt(FaceField field, FacePlace place, vec2 at) {
    uint number = faceNumber(place.model, place.leaf, uvec3(place.voxel), place.face);
    if (number == kNoFace) return kNoFaceLight;
    uint word = FaceValues(field.values).at[place.firstFace + number];
    uint level = isEscape(word) ? word >> kFaceLevelShift & 3u : 0u;
    if (isEscape(word) && level == 0u) return kNoFaceLight;
    float edge = float(1u << level);
    vec2 own = clamp(floor(at * edge), vec2(0.0), vec2(edge - 1.0));
    vec2 off = at * edge - own - 0.5;  // from its middle, in values
    vec2 side = mix(vec2(1.0), vec2(-1.0), lessThan(off, vec2(0.0)));
    vec2 far = abs(off);

    vec3 middle = valueAt(field, word, at).indirect;
    FaceLight besideU = latticeValue(field, place, word, edge, own + vec2(side.x, 0.0));
    FaceLight besideV = latticeValue(field, place, word, edge, own + vec2(0.0, side.y));
    FaceLight across = kNoFaceLight;
    if (besideU.known || besideV.known) across = latticeValue(field, place, word, edge, own + side);
    vec4 weights = vec4((1.0 - far.x) * (1.0 - far.y), far.x * (1.0 - far.y), (1.0 - far.x) * far.y, far.x * far.y) *
                   vec4(1.0, float(besideU.known), float(besideV.known), float(across.known));
    vec3 mean = (weights.x * middle + weights.y * besideU.indirect + weights.z * besideV.indirect +
                 weights.w * across.indirect) / dot(weights, vec4(1.0));
    vec3 slope = vec3(0.0);
    if (!besideU.known) {
        FaceLight other = latticeValue(field, place, word, edge, own - vec2(side.x, 0.0));
        if (other.known) slope += far.x * (middle - other.indirect);
    }
    if (!besideV.known) {
        FaceLight other = latticeValue(field, place, word, edge, own - vec2(0.0, side.y));
        if (other.known) slope += far.y * (middle - other.indirect);
    }
    return FaceLight(max(mean + slope, 0.5 * mean), true);
}

// Of a node that stands for smaller ones.
FaceLight meanFaceLight(FaceField field, InstanceRecord instance, ModelRecord model, Hit hit, uint face) {
    uvec2 cell = FacePairs(model.faceCells).at[hit.node];
    uint directions = cell.x & kFaceDirections;
    if (directions == 0u) return kNoFaceLight;
    if ((directions >> face & 1u) == 0u) face = uint(findLSB(directions));  // none looks that way: any of it
    uint before = bitCount(directions & ((1u << face) - 1u));
    return valueAt(field, FaceValues(field.means).at[instance.firstMean + (cell.x >> kFaceSlotShift) + before], vec2(0.0));
}

// At the point where a ray has hit.
FaceLight faceLightOf(FaceField field, Scene sceneBuffer, Ray ray, Hit hit) {
    SceneHeader scene = sceneBuffer.header;
    InstanceRecord instance = Instances(scene.instances).at[hit.instance];
    FacePlace place;
    place.model = Models(scene.models).at[instance.model];
    place.firstFace = instance.firstFace;
    CubeHit found = cubeHitOf(place.model, cubeFromWorldPoint(instance, ray.origin),
                              cubeFromWorldVector(instance, ray.direction), hit);
    if (isLevelOfDetail(place.model, WideNodes(place.model.nodes).at[hit.node], hit))
        return meanFaceLight(field, instance, place.model, hit, min(found.face, 5u));
    place.leaf = leafOf(place.model, hit);
    if (found.face == kFaceInside)
        faceFromInside(place.model, place.leaf, cubeFromWorldVector(instance, ray.direction), found);
    if (found.face == kFaceInside) return kNoFaceLight;
    place.voxel = found.voxel;
    place.face = found.face;
    return faceLightAt(field, place, vec2(found.within[(found.axis + 1u) % 3u], found.within[(found.axis + 2u) % 3u]));
}

#endif
