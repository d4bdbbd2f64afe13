// Views that trace camera rays through the probe field instead of the octree, and compare.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

#include "view_frame.glsl"
#include "view_colors.glsl"
#include "probe_trace.glsl"

const float kSameDistance = 0.01;  // parts of it, beside a voxel

vec3 stateColor(FieldHit found) {
    if (found.state == kFieldHit) return vec3(0.20, 0.62, 0.24) * faceShade(found.normal);
    return found.state == kFieldMiss ? vec3(0.16, 0.36, 0.78) : vec3(0.90, 0.45, 0.08);
}

// Gray the same, nearly black both nothing; yellow to red another distance; cyan a hit where nothing is, purple nothing
// where something is; orange unknown.
vec3 differenceColor(FieldHit found, bool isHit, float t, vec3 normal, float voxelMetres, out bool agrees) {
    agrees = false;
    if (found.state == kFieldUnknown) return vec3(0.90, 0.45, 0.08);
    bool hit = found.state == kFieldHit;
    if (hit && !isHit) return vec3(0.10, 0.75, 0.85);
    if (!hit && isHit) return vec3(0.55, 0.05, 0.70);
    float apart = isHit ? abs(found.t - t) : 0.0;
    agrees = apart <= voxelMetres + kSameDistance * t;
    if (agrees) return isHit ? vec3(0.30) * faceShade(normal) : kBackground;
    return mix(vec3(0.90, 0.75, 0.05), vec3(0.85, 0.05, 0.02), clamp(4.0 * apart / max(t, 1e-6), 0.0, 1.0));
}

void main() {
    ViewParameters view = Parameters(push.parameters).view;
    Pixel pixel = pixelOf(view);
    beginCounting();
    if (pixel.inside) {
        Scene scene = Scene(push.scene);
        Ray ray = cameraRay(view, pixel.at);
        ProbeFieldRecord field = ProbeFieldRef(view.field).field;
        FieldStatistics fieldStatistics = FieldStatistics(0u, 0u, 0u, 0u);
        FieldHit found = traceField(field, FieldRay(ray.origin, ray.direction, kInfinity, false), fieldStatistics);
        count(kCountFieldStates + found.state, 1u);
        float distance = found.state == kFieldHit ? found.t : kInfinity;
        vec3 color = stateColor(found);
        if (view.mode == kViewFieldDifference) {
            TraceStatistics statistics = TraceStatistics(0u, 0u);
            ray.cone = 0.0;
            Hit hit = traceClosest(scene, ray, statistics);
            bool isHit = hit.instance != kNoInstance;
            vec3 normal = vec3(0.0, 1.0, 0.0);
            if (isHit) normal = surfaceOf(scene, ray, hit).normal;
            bool agrees;
            color = differenceColor(found, isHit, hit.t, normal, field.voxelMetres, agrees);
            distance = isHit ? hit.t : kInfinity;
            count(statistics);
            count(kCountHits, uint(isHit));
            count(kCountFieldAgrees, uint(agrees));
        }
        writeColor(view, pixel.index, color, distance);
    }
    endCounting();
}
