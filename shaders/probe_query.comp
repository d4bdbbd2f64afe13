// A batch of lookups or light-field rays through a probe field (shared/probes.glsl.h): tests and inspection.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

#include "probe_lookup.glsl"
#include "probe_trace.glsl"

layout(local_size_x = kProbeQueryGroupSize) in;

layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer Queries { ProbeQueryRecord at[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) writeonly buffer Answers { ProbeAnswerRecord at[]; };
layout(push_constant) uniform Push { ProbeQueryParameters push; };

ProbeAnswerRecord answerLookup(ProbeFieldRecord field, ProbeQueryRecord query) {
    ProbeLight light = lookUpProbes(field, query.position, query.direction, 0.0);
    return ProbeAnswerRecord(light.indirect, 0.0, query.direction, light.tier, vec4(light.weights, 0.0), kNoProbeIndex, 0u,
                             0u, 0u);
}

ProbeAnswerRecord answerTrace(ProbeFieldRecord field, ProbeQueryRecord query) {
    FieldRay ray = FieldRay(query.position, query.direction, query.tMax, push.mode == kQueryTraceHighOnly);
    FieldStatistics statistics = FieldStatistics(0u, 0u, 0u, 0u);
    FieldHit hit = push.mode == kQueryTraceFilled ? traceFieldFilled(field, ray, statistics)
                                                  : traceField(field, ray, statistics);
    return ProbeAnswerRecord(lightOfHit(field, hit), hit.t, hit.normal, hit.state, vec4(0.0), hit.probe,
                             statistics.lowSteps, statistics.highSteps, statistics.probes | statistics.stepLimitReached << 16);
}

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= push.count) return;
    ProbeFieldRecord field = ProbeFieldRef(push.field).field;
    ProbeQueryRecord query = Queries(push.queries).at[index];
    Answers(push.answers).at[index] =
        push.mode == kQueryLookup ? answerLookup(field, query) : answerTrace(field, query);
}
