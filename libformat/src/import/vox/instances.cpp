#include "import/vox/instances.hpp"

#include <fmt/format.h>

#include "import/vox/voxel_scatter.hpp"

namespace pfvox::import::vox {

namespace {

/// Its pivot in the origin, as a transform without translation places it.
GridInstance atOrigin(const VoxFile& file, std::uint32_t model) {
    return {.model = model,
            .worldFromModel = worldFromModel({}, file.models[model].size),
            .name = {},
            .layerId = -1};
}

Result<std::vector<GridInstance>> frameOfFile(const VoxFile& file, int frame, Diagnostics& diagnostics) {
    const auto frames = static_cast<std::uint32_t>(file.models.size());
    if (frames == 1) return std::vector{atOrigin(file, 0)};
    if (static_cast<std::uint32_t>(frame) >= frames) {
        return fail(ErrorCode::BadReference,
                    fmt::format("frame {} does not exist: the file has {} frames, 0 to {}", frame, frames,
                                frames - 1));
    }
    diagnostics.note("vox-frames",
                     fmt::format("the file has no scene graph, so its {} models are the frames of one "
                                 "object; frame {} is imported",
                                 frames, frame));
    return std::vector{atOrigin(file, static_cast<std::uint32_t>(frame))};
}

std::vector<GridInstance> everyModelOnce(const VoxFile& file, Diagnostics& diagnostics) {
    diagnostics.warn(
        "vox-graph-without-shapes",
        fmt::format("the scene graph shows no model; each of the {} is placed once, at the origin",
                    file.models.size()));
    std::vector<GridInstance> instances;
    for (std::uint32_t model = 0; model < file.models.size(); ++model)
        instances.push_back(atOrigin(file, model));
    return instances;
}

Result<std::vector<GridInstance>> instancesOfGraph(const VoxFile& file, const ImportSettings& settings,
                                                   const Limits& limits, Diagnostics& diagnostics) {
    PFVOX_TRY(
        const std::vector<Placement>, placements,
        expandGraph(file.graph, static_cast<std::uint32_t>(file.models.size()), settings.frame, limits));
    std::vector<GridInstance> instances;
    std::size_t dropped = 0;
    for (const Placement& placement : placements) {
        if (placement.hidden && !settings.includeHidden) {
            ++dropped;
            continue;
        }
        instances.push_back(
            {.model = placement.model,
             .worldFromModel = worldFromModel(placement.worldFromPivot, file.models[placement.model].size),
             .name = placement.name,
             .layerId = placement.layerId});
    }
    if (instances.empty() && dropped > 0) {
        return fail(
            ErrorCode::NothingToConvert,
            fmt::format("all {} instances are hidden; show them in MagicaVoxel, or import hidden ones too "
                        "(includeHidden)",
                        dropped));
    }
    if (dropped > 0) {
        diagnostics.note("vox-hidden-dropped", fmt::format("{} hidden instances are left out", dropped));
    }
    return instances;
}

}  // namespace

GridTransform worldFromModel(const GridTransform& voxWorldFromPivot, glm::ivec3 size) {
    const glm::i64vec3 pivot{size / 2};
    const GridTransform pivotFromVoxModel{.rotation = {}, .translation = -pivot};
    return worldFromVoxWorld() * voxWorldFromPivot * pivotFromVoxModel * modelFromVox(size).inverse();
}

Result<std::vector<GridInstance>> findInstances(const VoxFile& file, const ImportSettings& settings,
                                                const Limits& limits, Diagnostics& diagnostics) {
    if (settings.frame < 0) {
        return fail(ErrorCode::BadReference,
                    fmt::format("frame {} does not exist: frames begin at 0", settings.frame));
    }
    if (file.models.empty()) return fail(ErrorCode::NothingToConvert, "the file holds no voxel model");
    if (file.graph.nodes.empty()) return frameOfFile(file, settings.frame, diagnostics);
    if (!file.graph.hasShapes()) return everyModelOnce(file, diagnostics);
    return instancesOfGraph(file, settings, limits, diagnostics);
}

}  // namespace pfvox::import::vox
