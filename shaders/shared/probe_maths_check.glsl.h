// What probe_maths_check.comp and its test compute: every function of probe_maths.glsl.h on one input.
#ifndef PFVOX_SHARED_PROBE_MATHS_CHECK_GLSL_H
#define PFVOX_SHARED_PROBE_MATHS_CHECK_GLSL_H

#include "shared/probe_maths.glsl.h"

PFVOX_SHARED_BEGIN

PFVOX_CONSTANT(uint, kProbeMathsGroupSize, 64u);

PFVOX_STRUCT(ProbeMathsInput) {
    vec3 direction;  // unit length
    float metres;
    vec3 light;
    uint resolution;
    vec2 depthScaleAndLogRange;
    uint code;       // of a depth, not that of a miss
    uint word;       // any bits
};
PFVOX_SIZE(ProbeMathsInput, 48);

PFVOX_STRUCT(ProbeMathsOutput) {
    vec3 decoded;        // direction -> octahedral -> direction
    uint texel;          // index of the texel that the direction falls into
    vec3 texelDirection; // of that texel's center
    float solidAngle;    // of that texel
    vec3 normal;         // after packing
    uint normalBits;
    vec3 lightOfWord;    // all bits of the word, as R11G11B10F
    uint lightBits;
    vec2 momentsOfWord;
    uint momentsBits;    // of metres and its square
    uint depthBits;
    float depth;         // of the code
    uint finite;
    uint borderTexel;    // x and y of the source, 16 bits each, of texel (word, word / 256) of a map of `resolution`
    uint sees;           // a surface at `metres`, facing the probe at 60 degrees, in a texel that stores it 10 cm off
};
PFVOX_SIZE(ProbeMathsOutput, 96);
PFVOX_OFFSET(ProbeMathsOutput, momentsOfWord, 64);

PFVOX_STRUCT(ProbeMathsParameters) {
    uvec2 inputs;
    uvec2 outputs;
    uint count;
    uint reserved0;
    uint reserved1;
    uint reserved2;
};
PFVOX_SIZE(ProbeMathsParameters, 32);

PFVOX_FUNCTION ProbeMathsOutput checkProbeMaths(ProbeMathsInput i) {
    ProbeMathsOutput o;
    o.decoded = octDecode(octEncode(i.direction));
    o.texel = texelIndex(i.direction, i.resolution);
    uint x = o.texel % i.resolution;
    uint y = o.texel / i.resolution;
    o.texelDirection = directionOfTexel(x, y, i.resolution);
    o.solidAngle = texelSolidAngle(x, y, i.resolution);
    o.normalBits = packNormal(i.direction);
    o.normal = unpackNormal(o.normalBits);
    o.lightOfWord = unpackLight(i.word);
    o.lightBits = packLight(i.light);
    o.momentsOfWord = unpackMoments(i.word);
    o.momentsBits = packMoments(vec2(i.metres, i.metres * i.metres));
    o.depthBits = depthCode(i.metres, i.depthScaleAndLogRange.x, i.depthScaleAndLogRange.y);
    o.depth = depthOfCode(i.code, i.depthScaleAndLogRange.x, i.depthScaleAndLogRange.y);
    o.finite = isFiniteLight(i.word) ? 1u : 0u;
    int bordered = int(i.resolution) + 2;
    ivec2 source = borderSource(ivec2(int(i.word & 0xffffu) % bordered, int(i.word >> 16) % bordered), int(i.resolution));
    o.borderTexel = uint(source.x) | (uint(source.y) << 16);
    // A tangent, and a normal between it and the way back.
    vec3 d = i.direction;
    vec3 side = abs(d.x) < 0.5f ? normalize(vec3(0.0f, d.z, -d.y)) : normalize(vec3(d.z, 0.0f, -d.x));
    vec3 surface = normalize(vec3(side.x * 0.866f - d.x * 0.5f, side.y * 0.866f - d.y * 0.5f, side.z * 0.866f - d.z * 0.5f));
    uint stored = depthCode(i.metres + 0.1f, i.depthScaleAndLogRange.x, i.depthScaleAndLogRange.y);
    vec3 toPoint = vec3(d.x * i.metres, d.y * i.metres, d.z * i.metres);
    o.sees = seesSurface(packDepthNormal(stored, surface), toPoint, surface, i.resolution, i.depthScaleAndLogRange) ? 1u : 0u;
    return o;
}

PFVOX_SHARED_END
#endif
