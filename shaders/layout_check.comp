// Reads the shared structs member by member and writes what it finds, one word each: tests/gpu compares this with what
// C++ wrote into the same bytes. Element 1 of each array is read, so that the stride is checked as well.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

#include "shared/rays.glsl.h"
#include "shared/scene.glsl.h"
#include "shared/view.glsl.h"

layout(local_size_x = 1) in;

layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer Wide { WideNode at[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer BvhNodes { BvhNode at[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer Instances { InstanceRecord at[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer Models { ModelRecord at[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer Materials { MaterialRecord at[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer Scenes { SceneHeader at[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer Rays { RayRecord at[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer Hits { HitRecord at[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer Views { ViewParameters at[]; };
layout(buffer_reference, std430, buffer_reference_align = 4) writeonly buffer Words { uint at[]; };

// Every buffer holds the running numbers 0, 1, 2, ... as words.
layout(push_constant) uniform Push {
    uvec2 numbers;
    uvec2 found;
};

void put(uint index, uint word) { Words(found).at[index] = word; }
void put(uint index, float value) { put(index, floatBitsToUint(value)); }

void main() {
    WideNode wideNode = Wide(numbers).at[1];
    put(0u, wideNode.maskLow);
    put(1u, wideNode.kind);
    BvhNode bvhNode = BvhNodes(numbers).at[1];
    put(2u, bvhNode.first);
    put(3u, bvhNode.boxMax.z);
    put(4u, bvhNode.count);
    InstanceRecord instance = Instances(numbers).at[1];
    put(5u, instance.cubeFromWorld2.w);
    put(6u, instance.model);
    put(7u, instance.id);
    ModelRecord model = Models(numbers).at[1];
    put(8u, model.leafScale);
    put(9u, model.lods.x);
    put(10u, model.nodes.y);
    put(11u, uint(model.originVoxels.z));
    MaterialRecord material = Materials(numbers).at[1];
    put(12u, material.emissionStrength);
    put(13u, material.type);
    put(14u, material.alpha);
    SceneHeader scene = Scenes(numbers).at[1];
    put(15u, scene.materials.y);
    put(16u, scene.materialCount);
    RayRecord ray = Rays(numbers).at[1];
    put(17u, ray.tMax);
    put(18u, ray.direction.z);
    HitRecord hit = Hits(numbers).at[1];
    put(19u, hit.t);
    put(20u, hit.normal.z);
    put(21u, hit.material);
    put(22u, hit.stepLimitReached);
    ViewParameters view = Views(numbers).at[1];
    put(23u, view.samplesPerPixel);
    put(24u, view.mode);
    put(25u, view.exposure);
    put(26u, view.stepScale);
    put(27u, view.skyHorizon.z);
    put(28u, view.skyGround.z);
}
