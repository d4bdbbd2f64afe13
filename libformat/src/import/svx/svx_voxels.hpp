// From slices to voxels: which pixels are solid, and which material they have.
#pragma once

#include <array>
#include <pfvox/error.hpp>
#include <pfvox/import.hpp>
#include <pfvox/voxel_model.hpp>
#include <vector>

#include "import/svx/manifest.hpp"
#include "import/svx/slice_reader.hpp"

namespace pfvox::import::svx {

/// The channels that an import uses. Where solid matter is comes from the first of: density; the alpha of the
/// color channel; the sum of the material fractions.
struct ChannelPlan {
    const Channel* density = nullptr;
    const Channel* color = nullptr;
    std::array<const Channel*, 3> primaries{};  ///< red, green, blue; all or none, and none beside `color`
    std::vector<const Channel*> materials;

    bool hasColors() const { return color != nullptr || primaries[0] != nullptr; }
};

/// Fills `asset.models[0]` and `asset.materials`.
/// Errors: those of SliceReader; LimitExceeded (maxMemoryBytes, maxRegions); UnsupportedFeature when only
/// colors without alpha are there.
Result<void> readVoxels(SliceReader& reader, const ChannelPlan& plan, const Manifest& manifest,
                        const ImportSettings& settings, const Limits& limits, VoxelAsset& asset,
                        Diagnostics& diagnostics);

}  // namespace pfvox::import::svx
