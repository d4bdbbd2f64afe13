#include "bake/probe_placement.hpp"

#include <algorithm>
#include <cmath>
#include <pfvox/octree_walk.hpp>

namespace pfvox::bake {

namespace {

constexpr int kLatticeEdge = 7;
constexpr double kReachSteps = 0.45;
constexpr double kClampSteps = 0.25;

/// The nearest leaf of one model.
class Search {
  public:
    Search(const PlacedModel& placed, double shortest, const glm::dvec3& point, double limit)
        : linear_(placed.worldFromModel),
          local_(placed.modelFromWorld * glm::dvec4(point, 1.0)),
          shortest_(shortest),
          best_(limit) {}

    double run(const OctreeModel& model) {
        for (const OctreeRegion& region : model.regions) {
            if (region.tree.nodes.empty() ||
                isFar(glm::dvec3(region.bounds.min), glm::dvec3(region.bounds.max)))
                continue;
            node(region, 0, region.originVoxels, region.tree.depth - 1);
        }
        return best_;
    }

  private:
    glm::dvec3 gap(const glm::dvec3& low, const glm::dvec3& high) const {
        return local_ - glm::clamp(local_, low, high);
    }
    bool isFar(const glm::dvec3& low, const glm::dvec3& high) const {
        return shortest_ * glm::length(gap(low, high)) >= best_;
    }

    void node(const OctreeRegion& region, std::uint32_t index, glm::ivec3 corner, std::uint32_t level) {
        forEachChild(region.tree, index, [&](const NodeChild& child) {
            const glm::ivec3 at = corner + (cornerOfSlot(child.slot) << static_cast<int>(level));
            const glm::dvec3 low(at);
            const glm::dvec3 high = low + std::ldexp(1.0, static_cast<int>(level));
            if (isFar(low, high)) return;
            if (child.isLeaf) {
                best_ = std::min(best_, glm::length(linear_ * gap(low, high)));
            } else {
                node(region, child.index, at, level - 1);
            }
        });
    }

    glm::dmat3 linear_;
    glm::dvec3 local_;
    double shortest_;
    double best_;
};

double frobenius(const glm::dmat3& m) {
    return std::sqrt(glm::dot(m[0], m[0]) + glm::dot(m[1], m[1]) + glm::dot(m[2], m[2]));
}

bool isFree(const NearestSolid& nearest) {
    return nearest.voxelMetres == 0.0 || nearest.metres >= nearest.voxelMetres;
}

}  // namespace

SolidQuery::SolidQuery(std::span<const PlacedModel> models) {
    for (const PlacedModel& placed : models) {
        const glm::dmat3 linear(placed.worldFromModel);
        const double voxel =
            std::min({glm::length(linear[0]), glm::length(linear[1]), glm::length(linear[2])});
        coarsestVoxel_ = std::max(coarsestVoxel_, voxel);
        solids_.push_back({&placed, 1.0 / frobenius(glm::dmat3(placed.modelFromWorld)), voxel});
    }
}

NearestSolid SolidQuery::nearest(const glm::dvec3& point, double limitMetres) const {
    NearestSolid nearest{.metres = limitMetres, .voxelMetres = 0.0};
    for (const Solid& solid : solids_) {
        const double found =
            Search(*solid.placed, solid.shortest, point, nearest.metres).run(*solid.placed->model);
        if (found < nearest.metres) nearest = {.metres = found, .voxelMetres = solid.voxelMetres};
    }
    return nearest;
}

Placement placeProbe(const SolidQuery& solids, const ProbeGrid& grid, std::uint32_t probe, bool relocate) {
    const glm::dvec3 point(grid.pointOf(probe));
    const double clamp = static_cast<double>(std::min({grid.step.x, grid.step.y, grid.step.z})) * kClampSteps;
    const double limit = std::max(clamp, solids.coarsestVoxelMetres());
    if (isFree(solids.nearest(point, limit))) return {};
    Placement best{.state = ProbeState::Inactive};
    if (!relocate) return best;
    double bestScore = -std::numeric_limits<double>::infinity();
    for (int i = 0; i < kLatticeEdge * kLatticeEdge * kLatticeEdge; ++i) {
        const glm::dvec3 place(i % kLatticeEdge, i / kLatticeEdge % kLatticeEdge,
                               i / kLatticeEdge / kLatticeEdge);
        const glm::dvec3 offset =
            (place / (0.5 * (kLatticeEdge - 1)) - 1.0) * kReachSteps * glm::dvec3(grid.step);
        if (glm::length(offset) == 0.0) continue;
        const glm::vec3 rounded(offset);
        const NearestSolid nearest = solids.nearest(glm::dvec3(grid.pointOf(probe) + rounded), limit);
        const double score = std::min(nearest.metres, clamp) - glm::length(offset);
        if (!isFree(nearest) || !(score > bestScore)) continue;
        bestScore = score;
        best = {.state = ProbeState::Relocated, .offset = rounded};
    }
    return best;
}

}  // namespace pfvox::bake
