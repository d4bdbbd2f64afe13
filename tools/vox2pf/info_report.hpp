// Info report: what vox2pf info tells about a PF_VOX file, for people and as JSON
// (docs/schema/info.schema.json).
#pragma once

#include <filesystem>
#include <pfvox/octree.hpp>
#include <pfvox/pf_vox.hpp>
#include <string>
#include <vector>

#include "common/json.hpp"
#include "common/reporter.hpp"

namespace pfvox::tools {

/// A PF_VOX file with everything that is counted about it.
struct FileInfo {
    std::filesystem::path file;
    PfVoxHeader header;
    OctreeAsset asset;
    std::vector<OctreeStatistics> models;  ///< one for each model of the asset
    OctreeStatistics total;                ///< sums over the models, each counted once
    std::uint64_t instancedVoxels = 0;     ///< each model counted as often as it is placed
};

FileInfo makeFileInfo(std::filesystem::path file, PfVoxHeader header, OctreeAsset asset);

/// Tables, each ended by a newline. `complete`: every model and instance instead of the first few.
std::string infoText(const FileInfo& info, const Reporter& reporter, bool complete);

Json infoJson(const FileInfo& info);

}  // namespace pfvox::tools
