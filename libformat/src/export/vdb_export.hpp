// The module's side of exportVdb (pfvox/export.hpp).
#pragma once

#include <cstddef>
#include <pfvox/error.hpp>
#include <pfvox/limits.hpp>
#include <pfvox/octree.hpp>
#include <vector>

namespace pfvox::vdb_export {

/// See exportVdb in pfvox/export.hpp. No exception leaves it.
Result<std::vector<std::byte>> exportVdb(const OctreeAsset& asset, const Limits& limits,
                                         Diagnostics& diagnostics);

}  // namespace pfvox::vdb_export
