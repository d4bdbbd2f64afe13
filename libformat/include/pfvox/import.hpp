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
#include <vector>

namespace pfvox {

/// Options of the SVX importer (docs/import.md, "SVX").
struct SvxSettings {
    /// A voxel is solid when its density is at least this fraction of the slice's largest value, [0, 1]. The
    /// default puts the surface where an antialiased slice has it; 0 takes every voxel whose density is not
    /// zero.
    double threshold = 0.5;

    bool operator==(const SvxSettings&) const = default;
};

/// Which axis of a source points up.
enum class UpAxis : std::uint8_t { Y, Z };

/// Options of the OpenVDB importer (docs/import.md, "OpenVDB").
struct VdbSettings {
    /// Names of the grids to import, as reports show them ("density", "density[1]" for the second of two
    /// equal names). Empty: every grid that can be a model.
    std::vector<std::string> grids;
    /// Fog volumes: a voxel is solid when it is active and its value is greater than this.
    double threshold = 0.0;
    /// VDB files do not say which way is up. Z rotates (x, y, z) to (x, z, -y).
    UpAxis upAxis = UpAxis::Y;

    bool operator==(const VdbSettings&) const = default;
};

/// What a user can ask of an import. Every field takes part in the content key.
struct ImportSettings {
    bool merge = false;          ///< flatten all instances into one model
    bool includeHidden = false;  ///< keep hidden layers and nodes as visible instances
    int frame = 0;               ///< animation frame
    /// Edge of a voxel in metres. Default: what the file says, else 0.1 (MagicaVoxel has no unit).
    std::optional<double> voxelSizeMetres;
    SvxSettings svx;  ///< for .svx only
    VdbSettings vdb;  ///< for .vdb only

    bool operator==(const ImportSettings&) const = default;
};

inline constexpr double kDefaultVoxelSizeMetres = 0.1;  ///< where neither source nor settings tell

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
