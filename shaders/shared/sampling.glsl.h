// Random numbers of the baker, read by C++ and GLSL: integers only, so that every device draws the same ones.
//
// Points of the Sobol (0, 2) sequence, shuffled and scrambled by hashing (Owen's nested scrambling in the form of Laine
// and Karras 2011, "Stratified Sampling for Stochastic Transparency", with the constants of Vegdahl; padded to more
// dimensions as Burley 2020, "Practical Hash-based Owen Scrambling"); and the PCG hash (Jarzynski and Olano 2020, "Hash
// Functions for GPU Rendering") where stratification no longer pays.
#ifndef PFVOX_SHARED_SAMPLING_GLSL_H
#define PFVOX_SHARED_SAMPLING_GLSL_H

#include "shared/types.glsl.h"

PFVOX_SHARED_BEGIN

PFVOX_FUNCTION uint pcgHash(uint x) {
    uint state = x * 747796405u + 2891336453u;
    uint word = ((state >> ((state >> 28) + 4u)) ^ state) * 277803737u;
    return (word >> 22) ^ word;
}
PFVOX_FUNCTION uint joinHash(uint key, uint value) { return pcgHash(key ^ (value * 0x9e3779b9u + 0x85ebca6bu)); }

PFVOX_FUNCTION uint reversedBits(uint x) {
    x = ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
    x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
    x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
    x = ((x >> 8) & 0x00ff00ffu) | ((x & 0x00ff00ffu) << 8);
    return (x >> 16) | (x << 16);
}

// Each bit of the result depends on the lower ones only: a nested scramble of reversed fractions.
PFVOX_FUNCTION uint scrambledUpwards(uint x, uint seed) {
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
}

// The generator matrix of the second Sobol dimension is Pascal's triangle modulo 2; bits in the order of the index.
PFVOX_FUNCTION uint pascalProduct(uint x) {
    x ^= (x >> 1) & 0x55555555u;
    x ^= (x >> 2) & 0x33333333u;
    x ^= (x >> 4) & 0x0f0f0f0fu;
    x ^= (x >> 8) & 0x00ff00ffu;
    x ^= (x >> 16) & 0x0000ffffu;
    return x;
}

// [0, 1)
PFVOX_FUNCTION float unitFloat(uint bits) { return float(bits >> 8) * (1.0f / 16777216.0f); }

// Sample `index` of a pair of dimensions; `key` stands for everything but the index.
PFVOX_FUNCTION vec2 sobolPair(uint key, uint index) {
    uint shuffled = reversedBits(scrambledUpwards(reversedBits(index), key));
    uint x = reversedBits(scrambledUpwards(shuffled, joinHash(key, 1u)));
    uint y = reversedBits(scrambledUpwards(pascalProduct(shuffled), joinHash(key, 2u)));
    return vec2(unitFloat(x), unitFloat(y));
}

PFVOX_FUNCTION vec2 hashPair(uint key, uint index) {
    uint x = joinHash(key, index);
    return vec2(unitFloat(x), unitFloat(joinHash(x, 0x68bc21ebu)));
}

// What all numbers of one texel have in common.
PFVOX_FUNCTION uint texelKey(uint seedLow, uint seedHigh, uint probe, uint texel) {
    return joinHash(joinHash(joinHash(pcgHash(seedLow), seedHigh), probe), texel);
}

PFVOX_SHARED_END
#endif
