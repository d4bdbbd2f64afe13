#include "bake/surface_samples.hpp"

#include "bake/exposed_faces.hpp"

namespace pfvox::bake {

namespace {

/// Calls `visit` with each sample in the box.
template <class Visit>
void forEachSample(std::span<const PlacedModel> models, const ProximityGrid& shape, const Visit& visit) {
    const glm::dvec3 low(shape.start);
    const glm::dvec3 high = low + glm::dvec3(shape.step) * glm::dvec3(shape.counts);
    for (const PlacedModel& placed : models) {
        const std::vector<bool> all(placed.asset->materials.size(), true);
        const glm::dmat3 normals = glm::transpose(glm::dmat3(placed.modelFromWorld));
        forEachExposedFace(*placed.model, {.wanted = all, .hides = all}, [&](const VoxelFace& face) {
            glm::dvec3 middle = glm::dvec3(face.voxel) + 0.5;
            middle[face.axis()] += face.isUpper() ? 0.5 : -0.5;
            const glm::dvec3 position = placed.worldFromModel * glm::dvec4(middle, 1.0);
            if (glm::any(glm::lessThan(position, low)) || glm::any(glm::greaterThan(position, high))) return;
            const glm::dvec3 outward = (face.isUpper() ? 1.0 : -1.0) * normals[face.axis()];
            visit(SurfaceSample{.position = glm::vec3(position), .normal = glm::vec3(glm::normalize(outward))});
        });
    }
}

}  // namespace

ProximityGrid proximityShape(const ProbeGrid& probes, const glm::uvec3& cells) {
    const glm::vec3 size = probes.step * glm::vec3(probes.counts);
    return {.start = probes.start - 0.5f * probes.step, .step = size / glm::vec3(cells), .counts = cells, .probes = {}};
}

std::vector<SurfaceSample> surfaceSamples(std::span<const PlacedModel> models, const ProximityGrid& shape,
                                          std::uint64_t most) {
    std::uint64_t count = 0;
    forEachSample(models, shape, [&](const SurfaceSample&) { ++count; });
    const std::uint64_t stride = (count + most - 1) / std::max<std::uint64_t>(most, 1);
    std::vector<SurfaceSample> samples;
    samples.reserve(stride == 0 ? 0 : count / stride + 1);
    std::uint64_t index = 0;
    forEachSample(models, shape, [&](const SurfaceSample& sample) {
        if (index++ % stride == 0) samples.push_back(sample);
    });
    return samples;
}

}  // namespace pfvox::bake
