#include "measured_models.hpp"

#include <tbb/parallel_for.h>

#include <cmath>
#include <stdexcept>

#include "noise.hpp"

namespace pfvox::bench {

int terrainHeight(int x, int z) {
    return 500 + static_cast<int>(fractalNoise(x, z, 260.0f, 512.0f));
}

namespace {

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

/// Distance of the voxel's center from the cube's center.
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
            // Surface: some face neighbor is empty.
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

MeasuredModel makeTerrain(const std::string& name, int edge) {
    MeasuredModel model{.name = name, .edge = edge, .materialCount = 64, .voxels = {}};
    model.voxels = gatherColumns(edge, [](int x, int z, std::vector<PackedVoxel>& out) {
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
    if (name == "terrain") return makeTerrain(name, 2048);
    if (name == "landscape") return makeTerrain(name, 6144);
    throw std::invalid_argument("no measured model is called " + name);
}

}  // namespace pfvox::bench
