// Indirect light the slow, obvious way: plain paths in double precision over the reference caster, Lambert
// surfaces only. It shares no code with the baker.
#pragma once

#include <pfvox/scene.hpp>

namespace pfvox::test {

struct ReferenceLight {
    glm::dvec3 mean{0.0};
    double error = 0.0;  ///< standard error of the mean channel
};

/// I = E / pi at a point of a surface, as docs/baking.md means it: everything but the sun's own light there.
/// The scene has one part with an identity transform. `paths` of at most `bounces` reflections.
ReferenceLight referenceLight(const LoadedScene& scene, const glm::dvec3& position, const glm::dvec3& normal,
                              int paths, int bounces);

}  // namespace pfvox::test
