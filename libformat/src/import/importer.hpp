// Importer: what one source format gives to the registry (registry.cpp). A new format is a new folder with
// one function that returns this, and one line in the registry.
#pragma once

#include <filesystem>
#include <pfvox/import.hpp>
#include <span>

namespace pfvox::import {

/// The source as every importer sees it.
struct SourceBytes {
    std::span<const std::byte> bytes;
    std::filesystem::path file;  ///< name only: nothing is read through it
};

struct Importer {
    SourceFormat format;
    /// Whether the content is of this format; looks at the first bytes only.
    bool (*recognises)(const SourceBytes& source);
    Result<VoxelAsset> (*import)(const SourceBytes& source, const ImportSettings& settings,
                                 const Limits& limits, Diagnostics& diagnostics);
};

Importer voxImporter();
Importer svxImporter();
Importer vdbImporter();
Importer legacyImporter();

}  // namespace pfvox::import
