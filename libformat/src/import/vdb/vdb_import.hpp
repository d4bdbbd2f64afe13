// The importer of OpenVDB files. Lies in the module (vdb_module/), as everything that knows OpenVDB.
#pragma once

#include "import/importer.hpp"

namespace pfvox::import::vdb {

/// Errors as Importer::import. No exception leaves it.
Result<VoxelAsset> importVdb(const SourceBytes& source, const ImportSettings& settings, const Limits& limits,
                             Diagnostics& diagnostics);

}  // namespace pfvox::import::vdb
