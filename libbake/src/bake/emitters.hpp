// Emissive voxels as light sources that a path can look for.
#pragma once

#include <span>
#include <vector>

#include "bake/placed_models.hpp"
#include "shared/bake.glsl.h"

namespace pfvox::bake {

struct EmitterList {
    std::vector<shared::EmitterFace>
        faces;           ///< with their alias table: a face is picked by area x mean radiance
    float power = 0.0f;  ///< sum of area x mean radiance
};

/// Exposed faces of all emissive voxels, in the order of instances and leaves. A face is exposed where no
/// opaque voxel of the same model touches it.
EmitterList makeEmitters(std::span<const PlacedModel> models);

/// Linear radiance that a material emits.
glm::dvec3 emittedRadiance(const Material& material);

/// Fills threshold and alias so that slot k, taken below its threshold, else its alias, has the probability
/// weights[k] / sum (Vose 1991, "A Linear Algorithm for Generating Random Numbers with a Given
/// Distribution").
void makeAliasTable(std::span<const double> weights, std::span<shared::EmitterFace> faces);

}  // namespace pfvox::bake
