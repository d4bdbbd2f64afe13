// Instances: which models of a VOX file are shown and where, in pfvox axes and whole voxels.
#pragma once

#include <pfvox/import.hpp>
#include <string_view>
#include <vector>

#include "import/vox/rotation.hpp"
#include "import/vox/vox_file.hpp"

namespace pfvox::import::vox {

/// One placement of a model.
struct GridInstance {
    std::uint32_t model = 0;  ///< index into VoxFile::models
    GridTransform
        worldFromModel;     ///< voxels of the VoxelModel (voxel_scatter.hpp) to voxels of the world, +Y up
    std::string_view name;  ///< a view into the file's bytes
    std::int32_t layerId = -1;
};

/// The placement rule of MagicaVoxel, as one exact transform. With the model's pivot c = floor(size / 2),
/// voxel p of the model becomes world voxel floor(R (p + 1/2 - c) + t), all in VOX axes. Voxel centers are at
/// half numbers on both sides and R is a signed permutation, so the floor only takes the half off again and
/// cubes map onto cubes.
GridTransform worldFromModel(const GridTransform& voxWorldFromPivot, glm::ivec3 size);

/// The instances to import, in depth-first order of the scene graph.
///   - A file with a scene graph: the placements that are visible, or all of them with
///   settings.includeHidden.
///   - A file without one: its models are the frames of one object; settings.frame selects, and the model's
///     pivot comes to lie in the origin.
///   - A graph without shapes (old files whose root is its own child): every model once, as above.
/// Errors: those of expandGraph; NothingToConvert without models or with all instances hidden; BadReference
/// for a frame that does not exist. Diagnostics: vox-frames, vox-graph-without-shapes, vox-hidden-dropped.
Result<std::vector<GridInstance>> findInstances(const VoxFile& file, const ImportSettings& settings,
                                                const Limits& limits, Diagnostics& diagnostics);

}  // namespace pfvox::import::vox
