// The maths of probe maps, read by C++ and GLSL: octahedral mapping, packs, depth codes, borders, and the test whether
// a stored texel sees a surface point. One text, so that what one side packs the other unpacks. Integers decide wherever
// bits are stored; what is left to the driver is log, exp and rounding of sums, so that codes of two devices may differ
// by one.
//
// Octahedral map: +z in the middle, texture coordinate = (o + 1) / 2, o in [-1, 1]^2; center of texel (i, j) =
// ((i, j) + 0.5) / resolution. Distances in metres.
#ifndef PFVOX_SHARED_PROBE_MATHS_GLSL_H
#define PFVOX_SHARED_PROBE_MATHS_GLSL_H

#include "shared/types.glsl.h"

#ifdef __cplusplus
#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#endif

PFVOX_SHARED_BEGIN

#ifdef __cplusplus
using glm::abs;
using glm::clamp;
using glm::dot;
using glm::exp;
using glm::floatBitsToUint;
using glm::floor;
using glm::log;
using glm::max;
using glm::min;
using glm::normalize;
using glm::sqrt;
using glm::uintBitsToFloat;
#endif

PFVOX_CONSTANT(uint, kDepthMiss, 65535u);     // the texel sees no surface
PFVOX_CONSTANT(uint, kMaxDepthCode, 65534u);  // Far, and all beyond
PFVOX_CONSTANT(uint, kMinDepthBlock, 16u);    // texels of a min map stand for so many squared
PFVOX_CONSTANT(float, kTexelRadiansOfResolution1, 4.5573f);  // of a typical wide texel, times S: 0.255 degrees at 1024
PFVOX_CONSTANT(float, kSurfaceSlackMetres, 0.01f);
PFVOX_CONSTANT(float, kSurfaceSlackTexels, 0.75f);
PFVOX_CONSTANT(float, kSurfaceMinCosine, 0.05f);
PFVOX_CONSTANT(float, kSurfaceMinNormalDot, 0.9f);
PFVOX_CONSTANT(float, kSurfaceMinAgreement, 0.45f);  // of the bilinear weights of four texels
PFVOX_CONSTANT(float, kProximityLift, 1e-3f);        // of a cell, towards the viewer

// ---- Octahedral mapping ----

// 1 or -1, never 0: axes lie on the fold.
PFVOX_FUNCTION float signNotZero(float x) { return x >= 0.0f ? 1.0f : -1.0f; }

// Direction of any length but 0 -> [-1, 1]^2.
PFVOX_FUNCTION vec2 octEncode(vec3 v) {
    float scale = 1.0f / (abs(v.x) + abs(v.y) + abs(v.z));
    float x = v.x * scale;
    float y = v.y * scale;
    if (v.z >= 0.0f) return vec2(x, y);
    return vec2((1.0f - abs(y)) * signNotZero(x), (1.0f - abs(x)) * signNotZero(y));
}

// The point of the octahedron |x| + |y| + |z| = 1 that o stands for.
PFVOX_FUNCTION vec3 octUnfold(vec2 o) {
    float z = 1.0f - abs(o.x) - abs(o.y);
    if (z >= 0.0f) return vec3(o.x, o.y, z);
    return vec3((1.0f - abs(o.y)) * signNotZero(o.x), (1.0f - abs(o.x)) * signNotZero(o.y), z);
}

// [-1, 1]^2 -> unit direction.
PFVOX_FUNCTION vec3 octDecode(vec2 o) { return normalize(octUnfold(o)); }

PFVOX_FUNCTION vec2 octOfTexel(uint x, uint y, uint resolution) {
    float texel = 2.0f / float(resolution);
    return vec2((float(x) + 0.5f) * texel - 1.0f, (float(y) + 0.5f) * texel - 1.0f);
}

// Unit direction of a texel's center.
PFVOX_FUNCTION vec3 directionOfTexel(uint x, uint y, uint resolution) { return octDecode(octOfTexel(x, y, resolution)); }

// The texel coordinate, in texels, of a direction: its whole part is the texel that it falls into.
PFVOX_FUNCTION vec2 texelCoordinate(vec3 direction, uint resolution) {
    vec2 o = octEncode(direction);
    return vec2((o.x * 0.5f + 0.5f) * float(resolution), (o.y * 0.5f + 0.5f) * float(resolution));
}

// Word index of the texel that a direction falls into.
PFVOX_FUNCTION uint texelIndex(vec3 direction, uint resolution) {
    vec2 t = texelCoordinate(direction, resolution);
    uint last = resolution - 1u;
    return min(uint(max(t.x, 0.0f)), last) + resolution * min(uint(max(t.y, 0.0f)), last);
}

// Steradians: area on the octahedron's net over the cube of the distance to the octahedron.
PFVOX_FUNCTION float texelSolidAngle(uint x, uint y, uint resolution) {
    vec3 p = octUnfold(octOfTexel(x, y, resolution));
    float squared = dot(p, p);
    float texel = 2.0f / float(resolution);
    return texel * texel / (squared * sqrt(squared));
}

// The angle of a texel, radians, as the surface test means it: it was tuned with this figure. The widest texel, in the
// middle of an octant, has 2 sqrt(6) / resolution, 7 % more; the narrowest, at an axis, 2 / resolution.
PFVOX_FUNCTION float texelAngle(uint resolution) { return kTexelRadiansOfResolution1 / float(resolution); }

// ---- Border of one texel around maps that are read bilinearly ----

// The interior texel that texel (x, y) of a map with border repeats; x, y in [0, interior + 2).
PFVOX_FUNCTION ivec2 borderSource(ivec2 texel, int interior) {
    int x = texel.x - 1;
    int y = texel.y - 1;
    bool outX = x < 0 || x >= interior;
    bool outY = y < 0 || y >= interior;
    // Stepping over an edge of the net arrives on the same edge, mirrored about its middle.
    int sourceX = clamp(x, 0, interior - 1);
    int sourceY = clamp(y, 0, interior - 1);
    if (outY) sourceX = interior - 1 - sourceX;
    if (outX) sourceY = interior - 1 - sourceY;
    return ivec2(sourceX, sourceY);
}

// The coordinate, in texels of a map with border, at which a bilinear lookup reads a direction.
PFVOX_FUNCTION vec2 borderedCoordinate(vec3 direction, uint interior) {
    vec2 t = texelCoordinate(direction, interior);
    return vec2(t.x + 1.0f, t.y + 1.0f);
}

// ---- Normals: octahedral, two snorm8 ----

PFVOX_FUNCTION uint snorm8(float x) { return uint(int(floor(clamp(x, -1.0f, 1.0f) * 127.0f + 0.5f))) & 0xffu; }
PFVOX_FUNCTION float fromSnorm8(uint byteValue) { return max(float(int(byteValue << 24) >> 24) / 127.0f, -1.0f); }

// Unit normal -> bits 0-7 and 8-15.
PFVOX_FUNCTION uint packNormal(vec3 normal) {
    vec2 o = octEncode(normal);
    return snorm8(o.x) | (snorm8(o.y) << 8);
}
PFVOX_FUNCTION vec3 unpackNormal(uint bits) {
    return octDecode(vec2(fromSnorm8(bits & 0xffu), fromSnorm8((bits >> 8) & 0xffu)));
}

// ---- Depth codes ----

// `scale` = DepthEncoding::scale, `logRange` = log(scale * farMetres + 1). Never kDepthMiss.
PFVOX_FUNCTION uint depthCode(float metres, float scale, float logRange) {
    float t = log(scale * max(metres, 0.0f) + 1.0f) / logRange;
    return uint(min(floor(t * 65534.0f + 0.5f), 65534.0f));
}
// Precondition: code != kDepthMiss.
PFVOX_FUNCTION float depthOfCode(uint code, float scale, float logRange) {
    return (exp(float(code) / 65534.0f * logRange) - 1.0f) / scale;
}

PFVOX_FUNCTION uint packDepthNormal(uint code, vec3 normal) { return code | (packNormal(normal) << 16); }
PFVOX_FUNCTION uint depthCodeOf(uint word) { return word & 0xffffu; }
PFVOX_FUNCTION vec3 normalOf(uint word) { return unpackNormal(word >> 16); }
PFVOX_FUNCTION bool isMiss(uint word) { return (word & 0xffffu) == kDepthMiss; }

// ---- Small unsigned floats: 5 exponent bits, 5, 6 or 10 mantissa bits ----

// Nearest, ties to even; below 0 and NaN -> 0, too large -> the largest finite value.
PFVOX_FUNCTION uint packSmallFloat(float value, uint mantissaBits) {
    uint bits = floatBitsToUint(value);
    if (!(value > 0.0f) || bits > 0x7f800000u) return 0u;
    uint largest = (31u << mantissaBits) - 1u;
    if (bits == 0x7f800000u) return largest;
    uint exponent = bits >> 23;           // biased by 127
    uint mantissa = bits & 0x7fffffu;
    uint drop = 23u - mantissaBits;       // bits that do not fit
    uint kept = 0u;
    if (exponent > 112u) {                // normal: at least 2^-14
        kept = (exponent - 112u) << mantissaBits;
    } else {                              // denormal: the leading 1 becomes explicit and everything moves down
        mantissa = mantissa | 0x800000u;
        drop = drop + (113u - exponent);
        if (drop > 30u) return 0u;
    }
    kept = kept + (mantissa >> drop);
    uint rest = mantissa & ((1u << drop) - 1u);
    uint tie = 1u << (drop - 1u);
    if (rest > tie || (rest == tie && (kept & 1u) != 0u)) kept = kept + 1u;
    return min(kept, largest);
}

PFVOX_FUNCTION float unpackSmallFloat(uint code, uint mantissaBits) {
    uint exponent = code >> mantissaBits;
    uint mantissa = code & ((1u << mantissaBits) - 1u);
    if (exponent == 0u) return float(mantissa) * uintBitsToFloat((113u - mantissaBits) << 23);
    if (exponent == 31u) return uintBitsToFloat(0x7f800000u | (mantissa << (23u - mantissaBits)));
    return uintBitsToFloat(((exponent + 112u) << 23) | (mantissa << (23u - mantissaBits)));
}

// R11G11B10F.
PFVOX_FUNCTION uint packLight(vec3 light) {
    return packSmallFloat(light.x, 6u) | (packSmallFloat(light.y, 6u) << 11) | (packSmallFloat(light.z, 5u) << 22);
}
PFVOX_FUNCTION vec3 unpackLight(uint word) {
    return vec3(unpackSmallFloat(word & 0x7ffu, 6u), unpackSmallFloat((word >> 11) & 0x7ffu, 6u),
                unpackSmallFloat(word >> 22, 5u));
}
PFVOX_FUNCTION bool isFiniteLight(uint word) {
    return (word & 0x7c0u) != 0x7c0u && (word & 0x3e0000u) != 0x3e0000u && (word & 0xf8000000u) != 0xf8000000u;
}

// Two halves; both are never negative.
PFVOX_FUNCTION uint packMoments(vec2 moments) {
    return packSmallFloat(moments.x, 10u) | (packSmallFloat(moments.y, 10u) << 16);
}
PFVOX_FUNCTION vec2 unpackMoments(uint word) {
    return vec2(unpackSmallFloat(word & 0x7fffu, 10u), unpackSmallFloat((word >> 16) & 0x7fffu, 10u));
}

// ---- Cells of the proximity grid ----

// Coordinate, in cells, of the point of a surface: its whole part is the cell. A point on the face between two cells
// belongs to the one that it is seen from.
PFVOX_FUNCTION vec3 proximityCoordinate(vec3 position, vec3 normal, vec3 start, vec3 cell) {
    return vec3((position.x - start.x) / cell.x + kProximityLift * normal.x,
                (position.y - start.y) / cell.y + kProximityLift * normal.y,
                (position.z - start.z) / cell.z + kProximityLift * normal.z);
}

// ---- Does a texel see a surface point? ----

// How far the stored and the true distance may differ, metres, for a surface that the texel meets at this cosine.
PFVOX_FUNCTION float surfaceTolerance(float distance, float cosine, uint resolution) {
    return kSurfaceSlackMetres + kSurfaceSlackTexels * texelAngle(resolution) * distance / max(abs(cosine), kSurfaceMinCosine);
}

// `word`: of the texel of a depth map of this resolution that the point falls into; `toPoint`: probe -> point, metres, not 0;
// `normal`: of the surface, unit. Of active probes.
PFVOX_FUNCTION bool seesSurface(uint word, vec3 toPoint, vec3 normal, uint resolution, vec2 depthScaleAndLogRange) {
    if (isMiss(word)) return false;
    if (dot(normalOf(word), normal) <= kSurfaceMinNormalDot) return false;
    float distance = sqrt(dot(toPoint, toPoint));
    float stored = depthOfCode(depthCodeOf(word), depthScaleAndLogRange.x, depthScaleAndLogRange.y);
    return abs(stored - distance) < surfaceTolerance(distance, dot(toPoint, normal) / distance, resolution);
}

PFVOX_SHARED_END
#endif
