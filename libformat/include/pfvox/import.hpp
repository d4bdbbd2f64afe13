// Importers: from a source file to a VoxelAsset.
//
//     [source file -> importer -> VoxelAsset] -> octree builder -> ...
//
// The format is found by content first and by file name second. Importers rotate into the frame of pfvox
// (right-handed, +Y up) and never mirror; source-specific facts are in docs/import.md.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <pfvox/error.hpp>
#include <pfvox/limits.hpp>
#include <pfvox/voxel_model.hpp>
#include <span>
#include <string>
#include <string_view>

namespace pfvox {

/// What a user can ask of an import. Every field takes part in the content key.
struct ImportSettings {
    bool merge = false;          ///< flatten all instances into one model
    bool includeHidden = false;  ///< keep hidden layers and nodes as visible instances
    int frame = 0;               ///< animation frame
    /// Edge of a voxel in metres. Default: what the file says, else 0.1 (MagicaVoxel has no unit).
    std::optional<double> voxelSizeMetres;

    bool operator==(const ImportSettings&) const = default;
};

/// The settings as text, one spelling for one meaning: what the content key hashes.
std::string canonicalText(const ImportSettings& settings);

inline constexpr double kDefaultVoxelSizeMetres = 0.1;

/// A source format that pfvox reads.
struct SourceFormat {
    std::string_view id;         ///< "vox"
    std::string_view title;      ///< "MagicaVoxel"
    std::string_view extension;  ///< ".vox"
};

/// Every format, in the order in which files are sniffed.
std::span<const SourceFormat> sourceFormats();

/// Whether folder mode should pick this file up, by its name alone.
bool looksLikeSource(const std::filesystem::path& file);

/// Imports bytes already in memory. `file` is used for the extension and for messages only.
/// Errors: UnsupportedFormat with what the file really is where that is known (Git LFS pointer, SLAB6, ...),
/// Truncated, BadValue, BadReference, BadStructure, UnsupportedFeature, LimitExceeded, NothingToConvert.
Result<VoxelAsset> importBytes(std::span<const std::byte> bytes, const std::filesystem::path& file,
                               const ImportSettings& settings, const Limits& limits,
                               Diagnostics& diagnostics);

/// Reads the file and imports it. Further errors: FileNotFound, FileNotReadable, LimitExceeded
/// (maxFileBytes).
Result<VoxelAsset> importFile(const std::filesystem::path& file, const ImportSettings& settings,
                              const Limits& limits, Diagnostics& diagnostics);

}  // namespace pfvox
