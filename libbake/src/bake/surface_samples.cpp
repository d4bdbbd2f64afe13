#include "bake/surface_samples.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <optional>
#include <pfvox/octree_walk.hpp>

namespace pfvox::bake {

namespace {

struct WorldBox {
    glm::dvec3 min;
    glm::dvec3 max;
};

bool meets(const PlacedModel& placed, const WorldBox& box) {
    for (const OctreeRegion& region : placed.model->regions) {
        if (region.bounds.empty()) continue;
        const glm::dvec3 middle = 0.5 * (glm::dvec3(region.bounds.min) + glm::dvec3(region.bounds.max));
        const glm::dvec3 half = glm::dvec3(region.bounds.max) - middle;
        const glm::dvec3 center = placed.worldFromModel * glm::dvec4(middle, 1.0);
        glm::dvec3 reach(0.0);
        for (int axis = 0; axis < 3; ++axis)
            reach += half[axis] * glm::abs(glm::dvec3(placed.worldFromModel[axis]));
        if (glm::all(glm::lessThanEqual(center - reach, box.max)) &&
            glm::all(glm::greaterThanEqual(center + reach, box.min)))
            return true;
    }
    return false;
}

/// Of a face, from its middle on, in voxels: the middle, near the corners, near the edges' middles.
constexpr std::array<glm::dvec2, 9> kPlaces{{{0.0, 0.0},
                                             {-0.49, -0.49},
                                             {0.49, -0.49},
                                             {-0.49, 0.49},
                                             {0.49, 0.49},
                                             {-0.49, 0.0},
                                             {0.49, 0.0},
                                             {0.0, -0.49},
                                             {0.0, 0.49}}};
constexpr std::size_t kCorners = 4;

/// Calls `visit` with the samples of a model that lie in the grid's box, always in the same order: the middle
/// of each exposed face, and of the places around it those in cells of their own, or strips of faces would
/// have no probes.
template <class Visit>
void forEachSample(const PlacedModel& placed, const ProximityGrid& shape, const Visit& visit) {
    const std::vector<bool> all(placed.asset->materials.size(), true);
    const glm::dmat3 normals = glm::transpose(glm::dmat3(placed.modelFromWorld));
    forEachExposedFace(*placed.model, {.wanted = all, .hides = all}, [&](const VoxelFace& face) {
        glm::dvec3 middle = glm::dvec3(face.voxel) + 0.5;
        middle[face.axis()] += face.isUpper() ? 0.5 : -0.5;
        const glm::vec3 normal(glm::normalize((face.isUpper() ? 1.0 : -1.0) * normals[face.axis()]));
        std::array<std::optional<std::uint32_t>, kPlaces.size()> cells;
        std::size_t distinct = 0;
        for (std::size_t i = 0; i < kPlaces.size(); ++i) {
            if (i > kCorners && distinct == 1) break;  // the whole face lies in one cell
            glm::dvec3 point = middle;
            point[(face.axis() + 1) % 3] += kPlaces[i].x;
            point[(face.axis() + 2) % 3] += kPlaces[i].y;
            const SurfaceSample sample{.position = glm::vec3(placed.worldFromModel * glm::dvec4(point, 1.0)),
                                       .normal = normal};
            cells[i] = cellOfSurface(shape, sample);
            const auto before = cells.begin() + static_cast<std::ptrdiff_t>(i);
            if (i != 0 && std::find(cells.begin(), before, cells[i]) != before) continue;
            ++distinct;
            if (cells[i]) visit(sample);
        }
    });
}

}  // namespace

ProximityGrid proximityShape(const ProbeGrid& probes, const glm::uvec3& cells, const WorldBounds& surfaces) {
    constexpr float kMargin = 0.1f;  // of a step: what lies on the faces of the scene's box is inside
    glm::vec3 low = probes.start - kProximityReach * probes.step;
    glm::vec3 high = probes.start + (glm::vec3(probes.counts - 1u) + kProximityReach) * probes.step;
    if (!surfaces.empty()) {
        const glm::vec3 tightLow =
            glm::max(low, glm::vec3(surfaces.min - probes.origin) - kMargin * probes.step);
        const glm::vec3 tightHigh =
            glm::min(high, glm::vec3(surfaces.max - probes.origin) + kMargin * probes.step);
        if (glm::all(glm::lessThan(tightLow, tightHigh))) {
            low = tightLow;
            high = tightHigh;
        }
    }
    return {.start = low, .step = (high - low) / glm::vec3(cells), .counts = cells, .probes = {}};
}

std::vector<SurfaceSample> surfaceSamples(std::span<const PlacedModel> models, const ProximityGrid& shape,
                                          std::uint64_t most) {
    const glm::dvec3 low(shape.start);
    const WorldBox box{.min = low, .max = low + glm::dvec3(shape.step) * glm::dvec3(shape.counts)};
    // Counted first: all samples at once may not fit into memory.
    std::vector<std::uint64_t> firstOfModel(models.size() + 1);
    tbb::parallel_for(std::size_t{0}, models.size(), [&](std::size_t i) {
        if (meets(models[i], box))
            forEachSample(models[i], shape, [&](const SurfaceSample&) { ++firstOfModel[i + 1]; });
    });
    std::partial_sum(firstOfModel.begin(), firstOfModel.end(), firstOfModel.begin());
    const std::uint64_t stride =
        std::max<std::uint64_t>((firstOfModel.back() + most - 1) / std::max<std::uint64_t>(most, 1), 1);
    std::vector<SurfaceSample> samples((firstOfModel.back() + stride - 1) / stride);
    tbb::parallel_for(std::size_t{0}, models.size(), [&](std::size_t i) {
        std::uint64_t index = firstOfModel[i];
        if (index == firstOfModel[i + 1]) return;
        forEachSample(models[i], shape, [&](const SurfaceSample& sample) {
            if (index % stride == 0) samples[index / stride] = sample;
            ++index;
        });
    });
    return samples;
}

}  // namespace pfvox::bake
