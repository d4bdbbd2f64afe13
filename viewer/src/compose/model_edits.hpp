// Model edits: what keys, handles and fields do to a placed model.
#pragma once

#include <pfvox/scene.hpp>

namespace pfvox::viewer {

/// The middle of the lower face: what a model stands on, turns and grows about. The origin for an empty box.
glm::dvec3 footOf(const WorldBounds& box);

/// Turned counter-clockwise about the vertical through `center`. A model that is scaled differently along the
/// axes keeps its place, for the scene file scales after it turns.
SceneModel turnedAbout(SceneModel model, const glm::dvec3& center, double radians);

/// How large: `factor` times as large as now, `center` staying where it is. `voxelMetres` is the file's own
/// voxel size, which counts while the model has none.
struct Resize {
    double factor = 1.0;
    glm::dvec3 center{0.0};
    double voxelMetres = 1.0;
};
SceneModel resized(SceneModel model, const Resize& resize);

/// Angles about x, then y, then z, the axes fixed, of the rotation that is `radians` about the vertical after
/// `rotate`.
glm::dvec3 turnedAngles(const glm::dvec3& rotateRadians, double radians);

/// A grid as a request that gives all of it, in the fewest digits that stand for its single-precision
/// numbers.
ProbeGridRequest requestOf(const ProbeGrid& grid, const glm::uvec3& proximityCells);

}  // namespace pfvox::viewer
