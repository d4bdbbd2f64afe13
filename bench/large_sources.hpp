// The large and the hostile sources of import's table (docs/performance.md), each made into a folder.
#pragma once

#include <filesystem>

namespace pfvox::bench {

/// 25 million voxels: 2048^2 columns, 6 thick, in 8 x 8 models.
void writeTerrainShell(const std::filesystem::path& file);
/// A scene of that terrain with 35 of the demo's models on it, for baker and viewer: terrain_shell.vox and
/// the sources of data/ are to lie beside it.
void writeValley(const std::filesystem::path& file);
/// 115 million voxels, 461 MB: 1024^2 columns filled to the ground.
void writeSolidTerrain(const std::filesystem::path& file);
/// `count` instances of 12 models, in rows.
void writeInstances(const std::filesystem::path& file, int count);
/// 527 files of one small model each.
void writeSmallFiles(const std::filesystem::path& folder);
/// One small file, cut at 100 places.
void writeCutFiles(const std::filesystem::path& folder);
/// 81 files whose root node is its own child.
void writeSelfCycles(const std::filesystem::path& folder);
/// Half a ball of about 890,000 voxels in one model of 256^3: the size of a well-known planet.
void writeHalfPlanet(const std::filesystem::path& file);
/// About 848,000 voxels in one model, a stack of solid steps: the size of a well-known monument.
void writeMonument(const std::filesystem::path& file);
/// 64 bytes that claim a model of 65536 x 65536.
void writeLiar(const std::filesystem::path& file);
/// An OpenVDB fog volume: a ball of radius 400, 268 million active voxels, most of them in tiles.
void writeFogBall(const std::filesystem::path& file);
/// An OpenVDB mask with two voxels 10^9 apart.
void writeFarApart(const std::filesystem::path& file);
/// An OpenVDB mask: a shell one voxel thick with a diameter of 4000, 50 million voxels in 4096^3.
void writeHugeShell(const std::filesystem::path& file);

}  // namespace pfvox::bench
