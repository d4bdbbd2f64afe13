// A ray through what one probe sees (McGuire et al. 2017, "Real-Time Global Illumination using Precomputed Light Field
// Probes").
//
//     traceProbe -> segments -> texels
//
// Between two planes through the probe a ray stays in one octant, where the octahedral map is a perspective projection:
// there the ray is a straight line, and its parameter t is the perspective-correct interpolation of those at the ends
// of the segment. Texels are visited one by one along that line (Amanatides and Woo 1987), those of the min map first and
// those below one only where its nearest surface is nearer than the ray. A walk never turns back, so it ends.
//
// A miss is certain: the probe has seen past all of the ray. A hit: the ray crosses, from its front, the plane that a texel
// shows, and the probe sees that plane where it is crossed. Unknown: the ray goes behind what the probe sees, by way of what
// it does not see (docs/decisions/031-field-crossing.md).
#ifndef PFVOX_PROBE_WALK_GLSL
#define PFVOX_PROBE_WALK_GLSL

#include "probe_field.glsl"

const float kDegenerateVoxels = 0.03;  // shorter pieces of a ray are left out
const float kSamePlaneVoxels = 0.25;   // how far two texels' surfaces may lie apart and be one plane
const float kSamePlaneFraction = 1e-3;    // of the distance to the plane: depth codes are no finer

struct FieldHit {
    uint state;   // kField...
    float t;
    vec3 normal;
    uint probe;
    uint texel;   // word of its depth map
};

struct FieldStatistics {
    uint lowSteps;
    uint highSteps;
    uint probes;
    uint stepLimitReached;  // walks that were given up
};

struct FieldRay {
    vec3 origin;
    vec3 direction;  // unit
    float tMax;
    bool highOnly;   // without the min maps
};

// A piece of a ray in one octant of a probe; s runs from 0 to 1 along its line on the map.
struct FieldSegment {
    vec3 origin;     // relative to the probe
    vec3 direction;
    vec2 start;      // on the map, [0, 1]^2
    vec2 line;       // to the end
    float t0;
    float t1;
    float inverseNorm0;  // 1 / (|x| + |y| + |z|) at the ends
    float inverseNorm1;
};

float timeAt(FieldSegment segment, float s) {
    float a = (1.0 - s) * segment.inverseNorm0;
    float b = s * segment.inverseNorm1;
    return (segment.t0 * a + segment.t1 * b) / (a + b);
}

float distanceAt(FieldSegment segment, float t) { return length(segment.origin + t * segment.direction); }

// On the map, in an octant that is known: no side to choose where a component is 0.
vec2 mapInOctant(vec3 v, vec3 octant, out float inverseNorm) {
    vec3 p = max(v * octant, vec3(0.0));
    inverseNorm = 1.0 / max(p.x + p.y + p.z, 1e-20);
    p *= inverseNorm;
    vec2 o = octant.z > 0.0 ? p.xy : 1.0 - p.yx;
    return o * octant.xy * 0.5 + 0.5;
}

FieldSegment makeSegment(vec3 origin, vec3 direction, float t0, float t1) {
    vec3 middle = origin + 0.5 * (t0 + t1) * direction;
    vec3 octant = vec3(signNotZero(middle.x), signNotZero(middle.y), signNotZero(middle.z));
    vec3 start = origin + t0 * direction;
    vec3 end = origin + t1 * direction;
    // At the probe itself any direction will do but none.
    float tiny = 1e-6 * (1.0 + abs(t1 - t0));
    if (dot(start, start) < tiny * tiny) start = tiny * direction;
    if (dot(end, end) < tiny * tiny) end = -tiny * direction;
    FieldSegment segment;
    segment.origin = origin;
    segment.direction = direction;
    segment.t0 = t0;
    segment.t1 = t1;
    segment.start = mapInOctant(start, octant, segment.inverseNorm0);
    segment.line = mapInOctant(end, octant, segment.inverseNorm1) - segment.start;
    return segment;
}

// A walk over the texels of one edge along a line.
struct TexelWalk {
    ivec2 texel;
    vec2 next;   // s at which the line leaves the texel, along each axis
    vec2 perTexel;
    ivec2 way;
    float s;     // where it entered
};

TexelWalk beginTexelWalk(FieldSegment segment, float s, uint resolution) {
    TexelWalk walk;
    vec2 at = (segment.start + s * segment.line) * float(resolution);
    walk.texel = clamp(ivec2(floor(at)), ivec2(0), ivec2(resolution - 1u));
    walk.way = ivec2(segment.line.x >= 0.0 ? 1 : -1, segment.line.y >= 0.0 ? 1 : -1);
    vec2 pace = max(abs(segment.line) * float(resolution), vec2(1e-20));
    walk.perTexel = 1.0 / pace;
    vec2 start = segment.start * float(resolution);
    vec2 border = vec2(walk.texel + max(walk.way, ivec2(0)));
    walk.next = abs(border - start) * walk.perTexel;
    walk.s = s;
    return walk;
}

float exitOf(TexelWalk walk, float last) { return clamp(min(walk.next.x, walk.next.y), walk.s, last); }

// Ends of a line may lie on the border of the map; rounding must not lead over it.
void stepTexel(inout TexelWalk walk, float exit, uint resolution) {
    walk.s = exit;
    int axis = walk.next.x <= walk.next.y ? 0 : 1;
    int texel = walk.texel[axis] + walk.way[axis];
    bool inside = texel >= 0 && texel < int(resolution);
    if (inside) walk.texel[axis] = texel;
    walk.next[axis] = inside ? walk.next[axis] + walk.perTexel[axis] : 1e30;
}

uint minCodeAt(ProbeEntry probe, ivec2 texel, uint resolution) {
    uint index = uint(texel.x) + resolution * uint(texel.y);
    return ProbeWords(probe.minDepth).at[index >> 1] >> ((index & 1u) * 16u) & 0xffffu;
}

// What a texel shows, taken for a plane. Heights are along its normal.
struct SeenPlane {
    vec3 normal;
    float height;  // from the probe
};

float heightAbove(SeenPlane plane, FieldSegment segment, float t) {
    return dot(segment.origin + t * segment.direction, plane.normal) - plane.height;
}

float planeSlack(ProbeFieldRecord field, SeenPlane plane) {
    return max(kSamePlaneVoxels * field.voxelMetres, kSamePlaneFraction * abs(plane.height));
}

bool showsPlane(ProbeFieldRecord field, ProbeEntry probe, SeenPlane plane, ivec2 texel) {
    uint word = ProbeWords(probe.depthNormal).at[uint(texel.x) + field.depthResolution * uint(texel.y)];
    if (isMiss(word) || dot(normalOf(word), plane.normal) <= kSurfaceMinNormalDot) return false;
    vec3 view = directionOfTexel(uint(texel.x), uint(texel.y), field.depthResolution);
    float height = metresOfCode(field, depthCodeOf(word)) * dot(view, plane.normal);
    return abs(height - plane.height) < planeSlack(field, plane);
}

// Whether the probe sees a plane at a point of it (relative to the probe): by four texels, as the proximity grid asks.
bool seesPlaneAt(ProbeFieldRecord field, ProbeEntry probe, SeenPlane plane, vec3 point) {
    vec2 at = texelCoordinate(point, field.depthResolution) - 0.5;
    ivec2 low = ivec2(floor(at));
    vec2 fraction = at - vec2(low);
    float agreeing = 0.0;
    for (int i = 0; i < 4; ++i) {
        ivec2 offset = ivec2(i & 1, i >> 1);
        vec2 near = mix(1.0 - fraction, fraction, vec2(offset));
        if (showsPlane(field, probe, plane, wrappedTexel(low + offset, field.depthResolution))) agreeing += near.x * near.y;
    }
    return agreeing >= kSurfaceMinAgreement;
}

// The texels between two places of a line. A miss is one of this piece only.
uint traceTexels(ProbeFieldRecord field, ProbeEntry probe, FieldSegment segment, vec2 span, inout float tMin,
                 inout FieldHit hit, inout FieldStatistics statistics) {
    uint resolution = field.depthResolution;
    TexelWalk walk = beginTexelWalk(segment, span.x, resolution);
    float tBefore = timeAt(segment, span.x);
    float before = distanceAt(segment, tBefore);
    for (uint step = 0u; step < 2u * resolution + 2u; ++step) {
        ++statistics.highSteps;
        float exit = exitOf(walk, span.y);
        float tAfter = timeAt(segment, exit);
        float after = distanceAt(segment, tAfter);
        uint index = uint(walk.texel.x) + resolution * uint(walk.texel.y);
        uint word = ProbeWords(probe.depthNormal).at[index];
        float depth = metresOfCode(field, depthCodeOf(word));
        if (max(before, after) >= depth) {
            vec3 view = directionOfTexel(uint(walk.texel.x), uint(walk.texel.y), resolution);
            SeenPlane plane = SeenPlane(normalOf(word), depth * dot(view, normalOf(word)));
            float pace = dot(segment.direction, plane.normal);
            // Behind the middle of the texel and still before its plane: the ray is free.
            if (pace >= 0.0 || heightAbove(plane, segment, tAfter) <= 0.0) {
                float crossing = -heightAbove(plane, segment, 0.0) / pace;
                bool fromFront = pace < 0.0 && heightAbove(plane, segment, tMin) >= -planeSlack(field, plane);
                if (fromFront && seesPlaneAt(field, probe, plane, segment.origin + crossing * segment.direction)) {
                    hit.state = kFieldHit;
                    hit.t = max(crossing, 0.0);
                    hit.normal = plane.normal;
                    hit.texel = index;
                    return kFieldHit;
                }
                tMin = max(tMin, tBefore);
                return kFieldUnknown;
            }
        }
        if (exit >= span.y) return kFieldMiss;
        stepTexel(walk, exit, resolution);
        tBefore = tAfter;
        before = after;
    }
    ++statistics.stepLimitReached;
    return kFieldUnknown;
}

uint traceSegment(ProbeFieldRecord field, ProbeEntry probe, FieldSegment segment, bool highOnly, inout float tMin,
                  inout FieldHit hit, inout FieldStatistics statistics) {
    if (highOnly) return traceTexels(field, probe, segment, vec2(0.0, 1.0), tMin, hit, statistics);
    uint resolution = field.depthResolution / kMinDepthBlock;
    TexelWalk walk = beginTexelWalk(segment, 0.0, resolution);
    float before = distanceAt(segment, segment.t0);
    for (uint step = 0u; step < 2u * resolution + 2u; ++step) {
        ++statistics.lowSteps;
        float exit = exitOf(walk, 1.0);
        float after = distanceAt(segment, timeAt(segment, exit));
        // The distance is convex along a line, so within the texel none is larger than at its ends.
        if (max(before, after) >= metresOfCode(field, minCodeAt(probe, walk.texel, resolution))) {
            uint state = traceTexels(field, probe, segment, vec2(walk.s, exit), tMin, hit, statistics);
            if (state != kFieldMiss) return state;
        }
        if (exit >= 1.0) return kFieldMiss;
        stepTexel(walk, exit, resolution);
        before = after;
    }
    ++statistics.stepLimitReached;
    return kFieldUnknown;
}

// Where the ray passes the three planes through the probe, in order, within [tMin, tMax].
vec3 octantBorders(vec3 origin, vec3 direction, float tMin, float tMax) {
    vec3 t = vec3(tMax);
    for (int axis = 0; axis < 3; ++axis)
        if (abs(direction[axis]) > 1e-12) t[axis] = clamp(-origin[axis] / direction[axis], tMin, tMax);
    if (t.x > t.y) t.xy = t.yx;
    if (t.y > t.z) t.yz = t.zy;
    if (t.x > t.y) t.xy = t.yx;
    return t;
}

uint traceProbe(ProbeFieldRecord field, ProbeEntry probe, FieldRay ray, inout float tMin, inout FieldHit hit,
                inout FieldStatistics statistics) {
    ++statistics.probes;
    vec3 origin = ray.origin - probe.position;
    vec3 borders = octantBorders(origin, ray.direction, tMin, ray.tMax);
    float ends[5] = float[5](tMin, borders.x, borders.y, borders.z, ray.tMax);
    for (int i = 0; i < 4; ++i) {
        if (ends[i + 1] - ends[i] < kDegenerateVoxels * field.voxelMetres) continue;
        FieldSegment segment = makeSegment(origin, ray.direction, ends[i], ends[i + 1]);
        uint state = traceSegment(field, probe, segment, ray.highOnly, tMin, hit, statistics);
        if (state != kFieldMiss) return state;
    }
    return kFieldMiss;
}

#endif
