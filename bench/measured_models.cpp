#include "measured_models.hpp"

#include <tbb/parallel_for.h>

#include <cmath>
#include <stdexcept>

namespace pfvox::bench {

namespace {

std::uint32_t hash32(std::uint32_t x) {
    x ^= x >> 16;
    x *= 0x7feb352du;
    x ^= x >> 15;
    x *= 0x846ca68bu;
    return x ^ (x >> 16);
}

std::uint32_t hashOf(int x, int y, int z) {
    const auto u = [](int v) { return static_cast<std::uint32_t>(v); };
    return hash32(u(x) * 73856093u ^ hash32(u(y) * 19349663u ^ hash32(u(z) + 83492791u)));
}

float valueNoise(float x, float z, std::uint32_t seed) {
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

int terrainHeight(int x, int z) {
    float height = 0.0f;
    float amplitude = 260.0f;
    float wavelength = 512.0f;
    for (std::uint32_t octave = 0; octave < 7; ++octave) {
        height += amplitude * valueNoise(static_cast<float>(x) / wavelength,
                                         static_cast<float>(z) / wavelength, hash32(octave + 17));
        amplitude *= 0.5f;
        wavelength *= 0.5f;
    }
    return 500 + static_cast<int>(height);
}

/// Runs makeColumn(x, z, out) for every column, in parallel over z, and joins the results in the order of z.
template <class MakeColumn>
std::vector<PackedVoxel> gatherColumns(int edge, const MakeColumn& makeColumn) {
    std::vector<std::vector<PackedVoxel>> rows(static_cast<std::size_t>(edge));
    tbb::parallel_for(0, edge, [&](int z) {
        for (int x = 0; x < edge; ++x) makeColumn(x, z, rows[static_cast<std::size_t>(z)]);
    });
    std::size_t count = 0;
    for (const auto& row : rows) count += row.size();
    std::vector<PackedVoxel> all;
    all.reserve(count);
    for (const auto& row : rows) all.insert(all.end(), row.begin(), row.end());
    return all;
}

PackedVoxel packed(int x, int y, int z, std::uint32_t material) {
    return {static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y), static_cast<std::uint16_t>(z),
            static_cast<MaterialIndex>(material)};
}

/// Distance of the voxel's centre from the cube's centre.
double distance(int edge, int x, int y, int z) {
    const double c = edge / 2 - 0.5;
    return std::sqrt((x - c) * (x - c) + (y - c) * (y - c) + (z - c) * (z - c));
}

MeasuredModel makeBall(const std::string& name, int edge, double radius) {
    MeasuredModel model{.name = name, .edge = edge, .materialCount = 9, .voxels = {}};
    model.voxels = gatherColumns(edge, [=](int x, int z, std::vector<PackedVoxel>& out) {
        for (int y = 0; y < edge; ++y) {
            const double d = distance(edge, x, y, z);
            if (d > radius) continue;
            // Surface: some face neighbour is empty.
            const bool surface = distance(edge, x + (x < edge / 2 ? -1 : 1), y, z) > radius ||
                                 distance(edge, x, y + (y < edge / 2 ? -1 : 1), z) > radius ||
                                 distance(edge, x, y, z + (z < edge / 2 ? -1 : 1)) > radius;
            out.push_back(packed(x, y, z, surface ? 1 + hashOf(x, y, z) % 8 : 0));
        }
    });
    return model;
}

MeasuredModel makeShell() {
    constexpr int kEdge = 2048;
    MeasuredModel model{.name = "shell", .edge = kEdge, .materialCount = 16, .voxels = {}};
    model.voxels = gatherColumns(kEdge, [](int x, int z, std::vector<PackedVoxel>& out) {
        const double c = kEdge / 2 - 0.5;
        const double r2 = (x - c) * (x - c) + (z - c) * (z - c);
        const auto consider = [&](int y) {
            if (std::abs(distance(kEdge, x, y, z) - 977.0) < 0.5) {
                out.push_back(packed(x, y, z, hashOf(x >> 3, y >> 3, z >> 3) % 16));
            }
        };
        const double outer = 977.5 * 977.5 - r2;
        if (outer < 0) return;
        const double inner = 976.5 * 976.5 - r2;
        const int far = static_cast<int>(std::sqrt(outer)) + 2;
        const int near = inner > 0 ? std::max(0, static_cast<int>(std::sqrt(inner)) - 2) : 0;
        for (int dy = -far; dy <= -near; ++dy) consider(kEdge / 2 + dy);
        for (int dy = std::max(near - 1, -near + 1); dy <= far; ++dy) consider(kEdge / 2 + dy);
    });
    return model;
}

MeasuredModel makeTerrain() {
    constexpr int kEdge = 2048;
    MeasuredModel model{.name = "terrain", .edge = kEdge, .materialCount = 64, .voxels = {}};
    model.voxels = gatherColumns(kEdge, [](int x, int z, std::vector<PackedVoxel>& out) {
        const int height = terrainHeight(x, z);
        const std::uint32_t patch = hashOf(x >> 6, 0, z >> 6) % 16;
        for (int y = height - 2; y <= height; ++y)
            out.push_back(packed(x, y, z, 4 * patch + hashOf(x, y, z) % 4));
    });
    return model;
}

}  // namespace

MeasuredModel makeMeasuredModel(const std::string& name) {
    if (name == "sphere") return makeBall(name, 512, 142.0);
    if (name == "tiny") return makeBall(name, 64, 20.0);
    if (name == "shell") return makeShell();
    if (name == "terrain") return makeTerrain();
    throw std::invalid_argument("no measured model is called " + name);
}

}  // namespace pfvox::bench
