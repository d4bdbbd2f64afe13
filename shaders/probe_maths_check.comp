// Runs every function of shared/probe_maths.glsl.h on what C++ gives it: tests/gpu compares the results with those of the
// same text compiled as C++.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

#include "shared/probe_maths.glsl.h"
#include "shared/probe_maths_check.glsl.h"

layout(local_size_x = kProbeMathsGroupSize) in;

layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer Inputs { ProbeMathsInput at[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) writeonly buffer Outputs { ProbeMathsOutput at[]; };

layout(push_constant) uniform Push { ProbeMathsParameters push; };

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.count) return;
    Outputs(push.outputs).at[i] = checkProbeMaths(Inputs(push.inputs).at[i]);
}
