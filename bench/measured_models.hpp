// The three models on which pfvox is measured (docs/performance.md):
//     sphere   solid ball of radius 142 in 512^3, 8 random surface materials over one interior   11,993,960
//     voxels shell    |distance - 977| < 0.5 in 2048^3, 16 materials in 8^3 blocks 12,004,656 voxels terrain
//     2048^2 columns, 3 thick, fractal noise height, 64 materials (2 random bits each)  12,582,912 voxels
// Each is solid, thin or noisy: what merges well, what does not, and what has no structure in its materials.
#pragma once

#include <array>
#include <cstdint>
#include <pfvox/voxel_model.hpp>
#include <string>
#include <vector>

namespace pfvox::bench {

struct MeasuredModel {
    std::string name;
    int edge = 0;  ///< of the cube in which it lies
    int materialCount = 0;
    std::vector<PackedVoxel> voxels;
};

/// "landscape" is the terrain over 6144^2 columns, 113 million voxels: larger than caches. "tiny" is a ball
/// of 33,000 voxels, for a test that the programs run.
inline constexpr std::array kMeasuredModelNames{"sphere", "shell", "terrain", "landscape", "tiny"};

/// Name is one of kMeasuredModelNames. The voxels come in an order that no octree uses: column by column.
MeasuredModel makeMeasuredModel(const std::string& name);

/// Of the terrain: the topmost voxel of a column.
int terrainHeight(int x, int z);

}  // namespace pfvox::bench
