// VoxFile: the content of a MagicaVoxel file as records, every chunk read and checked, nothing converted yet.
#pragma once

#include <array>
#include <optional>
#include <pfvox/asset.hpp>
#include <pfvox/limits.hpp>
#include <span>
#include <string>
#include <vector>

#include "import/vox/cameras.hpp"
#include "import/vox/materials.hpp"
#include "import/vox/palette.hpp"
#include "import/vox/scene_graph.hpp"

namespace pfvox::import::vox {

inline constexpr std::size_t kVoxelBytes = 4;

/// A pair of chunks SIZE and XYZI.
struct ModelRecord {
    glm::ivec3 size{0};                 ///< in VOX axes, z up
    std::span<const std::byte> voxels;  ///< bytes x, y, z and palette index of each; a view into the file
    std::uint64_t offsetBytes = 0;      ///< of the chunk XYZI

    std::size_t voxelCount() const { return voxels.size() / kVoxelBytes; }
};

struct VoxFile {
    std::vector<ModelRecord> models;
    SceneGraph graph;
    Palette palette = defaultPalette();
    std::array<MaterialRecord, kPaletteSize> materials;  ///< by voxel index; base colors not filled in
    std::vector<Camera> cameras;
    std::vector<Name> notes;
};

/// Reads all chunks. Views in the result point into `bytes`.
/// Errors: Truncated, BadMagic, BadValue, BadStructure, UnsupportedFeature (Teardown's TDCZ), LimitExceeded
/// (maxModels). Diagnostics: vox-version, vox-trailing-bytes, vox-imap-invalid, vox-duplicate-chunk,
/// vox-unknown-chunks, vox-pack-count, vox-size-too-large, vox-container-size, vox-camera-far.
Result<VoxFile> readVoxFile(std::span<const std::byte> bytes, double voxelSizeMetres, const Limits& limits,
                            Diagnostics& diagnostics);

}  // namespace pfvox::import::vox
