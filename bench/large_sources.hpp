// The large and the hostile sources of import's table (docs/performance.md), each made into a folder.
#pragma once

#include <filesystem>

namespace pfvox::bench {

/// 25 million voxels: 2048^2 columns, 6 thick, in 8 x 8 models.
void writeTerrainShell(const std::filesystem::path& file);
/// 115 million voxels, 461 MB: 1024^2 columns filled to the ground.
void writeSolidTerrain(const std::filesystem::path& file);
/// `count` instances of 12 models, in rows.
void writeInstances(const std::filesystem::path& file, int count);
/// 527 files of one small model each.
void writeSmallFiles(const std::filesystem::path& folder);
/// One small file, cut at 100 places.
void writeCutFiles(const std::filesystem::path& folder);
/// 64 bytes that claim a model of 65536 x 65536.
void writeLiar(const std::filesystem::path& file);
/// An OpenVDB fog volume: a ball of radius 400, 268 million active voxels, most of them in tiles.
void writeFogBall(const std::filesystem::path& file);

}  // namespace pfvox::bench
