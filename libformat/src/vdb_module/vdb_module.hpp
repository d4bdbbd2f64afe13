// VdbModule: what the module that knows OpenVDB offers to pfvox::import (docs/decisions/010-vdb-module.md).
//
//     pfvox::import -> [vdbModule(): dlopen on first use] -> VdbModule (a table of functions) -> OpenVDB
//
// A new function is a new field here and a new line in module_entry.cpp. Both sides must come from one build,
// which buildId decides, so the table needs no version of its own. What crosses has no virtual functions:
// each side has its own copy of what describes a class, and checks of the other's objects would fail.
#pragma once

#include <pfvox/error.hpp>
#include <pfvox/limits.hpp>
#include <pfvox/octree.hpp>
#include <vector>

#include "import/importer.hpp"

namespace pfvox {

/// A Diagnostics of the other side.
struct ReportTo {
    Diagnostics* sink;
    void (*report)(Diagnostics& sink, Diagnostic diagnostic);
};

struct VdbModule {
    const char* buildId;  ///< PFVOX_MODULE_ID of the module; always the first field, whatever else changes
    /// import::vdb::importVdb.
    Result<VoxelAsset> (*import)(const import::SourceBytes& source, const ImportSettings& settings,
                                 const Limits& limits, ReportTo diagnostics);
    /// vdb_export::exportVdb.
    Result<std::vector<std::byte>> (*exportAsset)(const OctreeAsset& asset, const Limits& limits,
                                                  ReportTo diagnostics);
};

/// The only symbol of the module: `const VdbModule* pfvoxVdbModule()`.
using VdbModuleEntry = const VdbModule* (*)();
inline constexpr const char* kVdbModuleEntry = "pfvoxVdbModule";

}  // namespace pfvox
