#include <algorithm>
#include <bit>
#include <cmath>

#include "support/reference_caster.hpp"

namespace pfvox {

namespace {

struct ModelRay {
    glm::dvec3 origin;
    glm::dvec3 direction;
};

struct Cube {
    glm::ivec3 corner{0};
    std::uint32_t depthBelow = 0;  ///< edge = 2^depthBelow voxels
    double edge() const { return std::ldexp(1.0, static_cast<int>(depthBelow)); }
    Cube child(std::uint32_t slot) const {
        const int half = 1 << (depthBelow - 1);
        const glm::ivec3 upper(slot & 1u, slot >> 1 & 1u, slot >> 2 & 1u);
        return {corner + half * upper, depthBelow - 1};
    }
};

struct Span {
    double enter = -std::numeric_limits<double>::infinity();
    double leave = std::numeric_limits<double>::infinity();
    int axis = -1;  ///< of the plane met last on the way in
};

/// The ray's part in the closed cube, axis by axis.
std::optional<Span> spanIn(const Cube& cube, const ModelRay& ray) {
    Span span;
    for (int axis = 0; axis < 3; ++axis) {
        const double low = cube.corner[axis];
        const double high = low + cube.edge();
        const double o = ray.origin[axis];
        const double d = ray.direction[axis];
        if (d == 0.0) {
            if (o < low || o > high) return std::nullopt;
            continue;
        }
        const double enter = ((d > 0.0 ? low : high) - o) / d;
        const double leave = ((d > 0.0 ? high : low) - o) / d;
        if (enter > span.enter) {
            span.enter = enter;
            span.axis = axis;
        }
        span.leave = std::min(span.leave, leave);
    }
    if (span.enter > span.leave || span.leave < 0.0) return std::nullopt;
    return span;
}

struct LeafHit {
    double t = std::numeric_limits<double>::infinity();
    glm::ivec3 voxel{0};
    Face face = Face::Inside;
    MaterialIndex material = 0;
};

/// Walks one model and keeps the nearest leaf.
class ModelWalk {
  public:
    ModelWalk(const OctreeModel& model, const ModelRay& ray, double tMax) : model_(model), ray_(ray) {
        nearest_.t = tMax;
    }

    std::optional<LeafHit> run() {
        const Cube cube{model_.originVoxels, model_.depth};
        if (model_.regions.empty()) return std::nullopt;
        if (model_.topTree.nodes.empty()) {
            walkRegion(model_.regions[0], 0, cube, std::nullopt);
        } else {
            walkTop(0, cube);
        }
        return found_ ? std::optional(nearest_) : std::nullopt;
    }

  private:
    /// Number of inner children in slots below this one: the children of a node are stored in slot order.
    static std::uint32_t rank(std::uint32_t mask, std::uint32_t slot) {
        return static_cast<std::uint32_t>(std::popcount(mask & ((1u << slot) - 1u)));
    }

    bool worthVisiting(const Cube& cube) const {
        const std::optional<Span> span = spanIn(cube, ray_);
        return span && span->enter <= nearest_.t;
    }

    void walkTop(std::uint32_t index, const Cube& cube) {
        const std::uint32_t descriptor = model_.topTree.nodes[index];
        for (std::uint32_t slot = 0; slot < 8; ++slot) {
            const Cube child = cube.child(slot);
            if ((node::validMask(descriptor) >> slot & 1u) == 0 || !worthVisiting(child)) continue;
            if ((node::leafMask(descriptor) >> slot & 1u) != 0) {
                walkRegion(regionAt(child.corner), 0, child, std::nullopt);
            } else {
                walkTop(model_.topTree.firstChild(index) + rank(node::innerMask(descriptor), slot), child);
            }
        }
    }

    /// Regions know where they begin; their order in the model is not needed.
    const OctreeRegion& regionAt(glm::ivec3 corner) const {
        return *std::ranges::find(model_.regions, corner, &OctreeRegion::originVoxels);
    }

    void walkRegion(const OctreeRegion& region, std::uint32_t index, const Cube& cube,
                    std::optional<MaterialIndex> hoisted) {
        const std::uint32_t descriptor = region.tree.nodes[index];
        for (std::uint32_t slot = 0; slot < 8; ++slot) {
            const Cube child = cube.child(slot);
            if ((node::validMask(descriptor) >> slot & 1u) == 0 || !worthVisiting(child)) continue;
            const std::optional<MaterialIndex> own = valueOf(region, index, slot);
            const std::optional<MaterialIndex> material = own ? own : hoisted;
            if ((node::leafMask(descriptor) >> slot & 1u) != 0) {
                meetLeaf(child, material.value_or(0));
            } else {
                walkRegion(region, region.tree.firstChild(index) + rank(node::innerMask(descriptor), slot),
                           child, material);
            }
        }
    }

    static std::optional<MaterialIndex> valueOf(const OctreeRegion& region, std::uint32_t index,
                                                std::uint32_t slot) {
        const std::uint32_t lookup = region.lookup[index];
        if ((lookup >> slot & 1u) == 0) return std::nullopt;
        const std::uint32_t value = region.value((lookup >> 8) + rank(lookup & 0xffu, slot));
        return region.palette[value];
    }

    void meetLeaf(const Cube& cube, MaterialIndex material) {
        const std::optional<Span> span = spanIn(cube, ray_);
        const double t = std::max(span->enter, 0.0);
        if (t > nearest_.t || (found_ && t == nearest_.t)) return;
        found_ = true;
        nearest_ = {.t = t, .voxel = voxelAt(cube, *span), .face = faceOf(*span), .material = material};
    }

    Face faceOf(const Span& span) const {
        if (span.enter < 0.0) return Face::Inside;
        return static_cast<Face>(2 * span.axis + (ray_.direction[span.axis] > 0.0 ? 0 : 1));
    }

    /// The voxel of the cube at the point where the ray comes in.
    glm::ivec3 voxelAt(const Cube& cube, const Span& span) const {
        const glm::dvec3 p = ray_.origin + std::max(span.enter, 0.0) * ray_.direction;
        const int edge = 1 << cube.depthBelow;
        glm::ivec3 voxel = glm::clamp(glm::ivec3(glm::floor(p)), cube.corner, cube.corner + edge - 1);
        if (span.enter >= 0.0) {
            const bool forward = ray_.direction[span.axis] > 0.0;
            voxel[span.axis] = forward ? cube.corner[span.axis] : cube.corner[span.axis] + edge - 1;
        }
        return voxel;
    }

    const OctreeModel& model_;
    ModelRay ray_;
    LeafHit nearest_;
    bool found_ = false;
};

bool isHidden(const OctreeAsset& asset, const Instance& instance) {
    const auto layer = static_cast<std::size_t>(instance.layer);
    return instance.hidden ||
           (instance.layer >= 0 && layer < asset.layers.size() && asset.layers[layer].hidden);
}

/// Normals go by the inverse transpose: the row of modelFromWorld that belongs to the face's axis.
glm::dvec3 worldNormal(const Affine& modelFromWorld, Face face) {
    if (face == Face::Inside) return glm::dvec3(0.0);
    const int axis = static_cast<int>(face) / 2;
    const double sign = static_cast<int>(face) % 2 == 0 ? -1.0 : 1.0;
    const glm::dvec3 row(modelFromWorld[0][axis], modelFromWorld[1][axis], modelFromWorld[2][axis]);
    return sign * glm::normalize(row);
}

}  // namespace

ReferenceCaster::ReferenceCaster(const OctreeAsset& asset) {
    for (std::uint32_t i = 0; i < asset.instances.size(); ++i) {
        const Instance& instance = asset.instances[i];
        if (isHidden(asset, instance) || glm::determinant(glm::dmat3(instance.worldFromModel)) == 0.0)
            continue;
        const Affine modelFromWorld{glm::inverse(glm::dmat4(instance.worldFromModel))};
        placed_.push_back(
            {.instance = i, .model = &asset.models[instance.model], .modelFromWorld = modelFromWorld});
    }
}

std::optional<ReferenceHit> ReferenceCaster::cast(const ReferenceRay& ray) const {
    std::optional<ReferenceHit> nearest;
    double tMax = ray.tMax;
    for (const Placed& placed : placed_) {
        // The direction keeps its length's meaning, so t is the same in the world and in the model.
        const ModelRay modelRay{.origin = placed.modelFromWorld * glm::dvec4(ray.origin, 1.0),
                                .direction = glm::dmat3(placed.modelFromWorld) * ray.direction};
        const std::optional<LeafHit> hit = ModelWalk(*placed.model, modelRay, tMax).run();
        if (!hit || (nearest && hit->t >= nearest->t)) continue;
        tMax = hit->t;
        nearest = ReferenceHit{.t = hit->t,
                               .instance = placed.instance,
                               .voxel = hit->voxel,
                               .face = hit->face,
                               .normal = worldNormal(placed.modelFromWorld, hit->face),
                               .material = hit->material};
    }
    return nearest;
}

}  // namespace pfvox
