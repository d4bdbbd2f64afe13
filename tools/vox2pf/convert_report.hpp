// Convert report: what vox2pf convert tells about its assets, for people and as JSON
// (docs/schema/convert.schema.json).
#pragma once

#include <span>
#include <string>

#include "common/json.hpp"
#include "common/reporter.hpp"
#include "vox2pf/convert_asset.hpp"

namespace pfvox::tools {

/// "converted hall.vox -> out/hall.pf_vox: 34,012 voxels, 12.1 KiB", with the reason behind it when
/// `explain`.
std::string assetLine(const AssetTask& task, const AssetResult& result, bool explain);

/// The object of one asset.
Json assetJson(const AssetTask& task, const AssetResult& result);

/// The end of a run: one line for one asset, a table for several. Each line ends with a newline.
std::string summary(std::span<const AssetTask> tasks, std::span<const AssetResult> results, double seconds);

}  // namespace pfvox::tools
