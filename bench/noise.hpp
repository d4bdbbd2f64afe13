// Hashes and value noise: chance that is the same on every machine and in every run.
#pragma once

#include <cmath>
#include <cstdint>

namespace pfvox::bench {

inline std::uint32_t hash32(std::uint32_t x) {
    x ^= x >> 16;
    x *= 0x7feb352du;
    x ^= x >> 15;
    x *= 0x846ca68bu;
    return x ^ (x >> 16);
}

inline std::uint32_t hashOf(int x, int y, int z) {
    const auto u = [](int v) { return static_cast<std::uint32_t>(v); };
    return hash32(u(x) * 73856093u ^ hash32(u(y) * 19349663u ^ hash32(u(z) + 83492791u)));
}

/// Smooth noise in [0, 1) with a random value at each whole (x, z).
inline float valueNoise(float x, float z, std::uint32_t seed) {
    const int xi = static_cast<int>(std::floor(x));
    const int zi = static_cast<int>(std::floor(z));
    const auto corner = [&](int a, int b) {
        const std::uint32_t h =
            static_cast<std::uint32_t>(a) * 73856093u ^ static_cast<std::uint32_t>(b) * 19349663u;
        return static_cast<float>(hash32(h ^ seed) >> 8) / 16777216.0f;
    };
    const auto smooth = [](float t) { return t * t * (3.0f - 2.0f * t); };
    const float fx = smooth(x - static_cast<float>(xi));
    const float fz = smooth(z - static_cast<float>(zi));
    const float near = corner(xi, zi) + (corner(xi + 1, zi) - corner(xi, zi)) * fx;
    const float far = corner(xi, zi + 1) + (corner(xi + 1, zi + 1) - corner(xi, zi + 1)) * fx;
    return near * (1.0f - fz) + far * fz;
}

/// A landscape: seven octaves, the first of this amplitude and wavelength, each next of half of both.
inline float fractalNoise(int x, int z, float amplitude, float wavelength) {
    float height = 0.0f;
    for (std::uint32_t octave = 0; octave < 7; ++octave) {
        height += amplitude * valueNoise(static_cast<float>(x) / wavelength,
                                         static_cast<float>(z) / wavelength, hash32(octave + 17));
        amplitude *= 0.5f;
        wavelength *= 0.5f;
    }
    return height;
}

}  // namespace pfvox::bench
