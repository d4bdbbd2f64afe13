// Between two vertices: how many workgroups the queues of a set need, and the other set is empty again.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

#include "bake_wave.glsl"

void main() {
    if (invocationIndex() != 0u) return;
    Controls controls = Controls(Waves(push.wave).at[0].control);
    uint rays = 0u;
    for (uint queue = 0u; queue <= kQueueEmitters; ++queue) {
        uint count = controls.control.waiting[push.set * kQueueKinds + queue];
        uint groups = (count + kBakeGroupSize - 1u) / kBakeGroupSize;
        controls.control.launch[4u * queue] = min(groups, kBakeRowGroups);
        controls.control.launch[4u * queue + 1u] = (groups + kBakeRowGroups - 1u) / kBakeRowGroups;
        controls.control.launch[4u * queue + 2u] = 1u;
        controls.control.waiting[(1u - push.set) * kQueueKinds + queue] = 0u;
        rays += count;
    }
    uint low = controls.control.raysLow;
    controls.control.raysLow = low + rays;
    if (low + rays < low) ++controls.control.raysHigh;
}
