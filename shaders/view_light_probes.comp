// Colors of a scene with probes.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

#define PFVOX_VIEW_PROBES
#include "view_light_pass.glsl"
