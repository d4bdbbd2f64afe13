#include "differential.hpp"

#include <tbb/parallel_for.h>

#include <cmath>
#include <pfvox/gpu_scene.hpp>
#include <pfvox/ray_query.hpp>
#include <sstream>

#include "support/gpu_fixture.hpp"
#include "support/reference_caster.hpp"

namespace pfvox::test {

namespace {

using Answer = std::optional<ReferenceHit>;

struct WorldBox {
    glm::dvec3 min{std::numeric_limits<double>::infinity()};
    glm::dvec3 max{-std::numeric_limits<double>::infinity()};
    glm::dvec3 center() const { return 0.5 * (min + max); }
    double radius() const { return 0.5 * glm::length(max - min); }
};

WorldBox boxOf(const OctreeAsset& asset) {
    WorldBox box;
    for (const Instance& instance : asset.instances) {
        const VoxelBox& b = asset.models[instance.model].bounds;
        for (int corner = 0; corner < 8; ++corner) {
            const glm::dvec4 p((corner & 1) != 0 ? b.max.x : b.min.x, (corner & 2) != 0 ? b.max.y : b.min.y,
                               (corner & 4) != 0 ? b.max.z : b.min.z, 1.0);
            const glm::dvec3 w = instance.worldFromModel * p;
            box.min = glm::min(box.min, w);
            box.max = glm::max(box.max, w);
        }
    }
    return box;
}

class RayMaker {
  public:
    RayMaker(Random& random, const OctreeAsset& asset) : random_(random), asset_(asset), box_(boxOf(asset)) {}

    FloatRay random() { return towards(outside(1.5), within()); }

    /// Along an axis of some instance; every other one exactly on a grid of half voxels.
    FloatRay axisParallel() {
        const Instance& instance = anyInstance();
        glm::dvec3 p = voxelPoint(instance);
        if (random_.integer(0, 1) == 0) p = glm::floor(2.0 * p) * 0.5;
        glm::dvec3 d(0.0);
        d[random_.integer(0, 2)] = random_.integer(0, 1) == 0 ? 1.0 : -1.0;
        const double back = 2.0 * box_.radius() / glm::length(glm::dmat3(instance.worldFromModel) * d);
        return inWorld(instance, p - back * d, d);
    }

    /// Aimed at the corner of a voxel, or along one of its edges.
    FloatRay cornerOrEdge() {
        const Instance& instance = anyInstance();
        const glm::dvec3 corner = glm::round(voxelPoint(instance));
        const glm::dvec3 world = instance.worldFromModel * glm::dvec4(corner, 1.0);
        return towards(outside(1.2), world);
    }

    FloatRay fromInside() { return {glm::vec3(within()), glm::vec3(random_.direction())}; }

    /// Almost parallel to a face of an instance's voxels, just beside one of its planes.
    FloatRay grazing() {
        const Instance& instance = anyInstance();
        const int axis = random_.integer(0, 2);
        glm::dvec3 p = voxelPoint(instance);
        p[axis] = std::round(p[axis]) + random_.uniform(-0.01, 0.01);
        glm::dvec3 d = random_.direction();
        d[axis] = random_.uniform(-1e-3, 1e-3);
        const double back = 2.0 * box_.radius() / glm::length(glm::dmat3(instance.worldFromModel) * d);
        return inWorld(instance, p - back * d, d);
    }

    FloatRay fromFar() { return towards(outside(60.0), within()); }

  private:
    const Instance& anyInstance() {
        const auto last = static_cast<int>(asset_.instances.size()) - 1;
        return asset_.instances[static_cast<std::size_t>(random_.integer(0, last))];
    }
    /// Where voxels are: the box of one region.
    glm::dvec3 voxelPoint(const Instance& instance) {
        const std::vector<OctreeRegion>& regions = asset_.models[instance.model].regions;
        const auto last = static_cast<int>(regions.size()) - 1;
        const VoxelBox& b = regions[static_cast<std::size_t>(random_.integer(0, last))].bounds;
        return {random_.uniform(b.min.x, b.max.x), random_.uniform(b.min.y, b.max.y),
                random_.uniform(b.min.z, b.max.z)};
    }
    glm::dvec3 within() {
        const Instance& instance = anyInstance();
        return instance.worldFromModel * glm::dvec4(voxelPoint(instance), 1.0);
    }
    glm::dvec3 outside(double radii) { return box_.center() + radii * box_.radius() * random_.direction(); }

    /// Lengths of directions vary: t counts in them.
    FloatRay towards(glm::dvec3 origin, glm::dvec3 target) {
        const double length = std::exp(random_.uniform(-2.0, 2.0));
        return {glm::vec3(origin), glm::vec3(length * glm::normalize(target - origin))};
    }
    static FloatRay inWorld(const Instance& instance, glm::dvec3 origin, glm::dvec3 direction) {
        return {glm::vec3(instance.worldFromModel * glm::dvec4(origin, 1.0)),
                glm::vec3(glm::dmat3(instance.worldFromModel) * direction)};
    }

    Random& random_;
    const OctreeAsset& asset_;
    WorldBox box_;
};

/// Judges one ray.
class Judge {
  public:
    explicit Judge(const OctreeAsset& asset) : asset_(asset), caster_(asset), box_(boxOf(asset)) {
        for (const Instance& instance : asset.instances) {
            const double edge = std::ldexp(1.0, static_cast<int>(asset.models[instance.model].depth) + 1);
            const glm::dmat3 shape(instance.worldFromModel);
            for (int axis = 0; axis < 3; ++axis)
                largestCube_ = std::max(largestCube_, edge * glm::length(shape[axis]));
        }
    }

    ReferenceRay exact(const FloatRay& ray) const {
        return {.origin = ray.origin, .direction = ray.direction};
    }
    Answer reference(const ReferenceRay& ray) const { return caster_.cast(ray); }

    bool same(const gpu::GpuHit& found, const Answer& expected, const FloatRay& ray) const {
        if (found.hit != expected.has_value()) return false;
        if (!expected) return true;
        return found.instance == expected->instance && found.voxel == expected->voxel &&
               found.face == static_cast<std::uint8_t>(expected->face) &&
               found.material == expected->material && sameDistance(found, *expected, ray) &&
               sameNormal(found, *expected);
    }

    /// Whether the GPU's answer is right within the tie distance: the ray passes the voxel that it names, and
    /// what the reference meets before is so thinly grazed that a ray beside this one passes it by.
    bool isTie(const gpu::GpuHit& found, const Answer& expected, const FloatRay& ray) const {
        if (found.hit && !passesNamedVoxel(found, ray)) return false;
        if (!expected) return true;
        const double tFound = found.hit ? found.t : std::numeric_limits<double>::infinity();
        const double cosine = expected->face == Face::Inside ? 1.0 : cosineOf(ray, expected->normal);
        const double tSlack =
            2.0 * kTieDistance * reachOf(ray) / std::max(cosine, 1e-3) / glm::length(ray.direction);
        return expected->t >= tFound - tSlack || passesBeside(ray, tFound - tSlack) ||
               meetsOnlyCorners(ray, expected->t, std::min(tFound - tSlack, sceneEnd(ray)));
    }

  private:
    static double cosineOf(const FloatRay& ray, glm::dvec3 normal) {
        return std::abs(glm::dot(glm::normalize(glm::dvec3(ray.direction)), normal));
    }

    /// The voxel is there, is of that material, and the hit point is in it or beside it.
    bool passesNamedVoxel(const gpu::GpuHit& found, const FloatRay& ray) const {
        const Instance& instance = asset_.instances[found.instance];
        if (asset_.models[instance.model].at(found.voxel) != found.material) return false;
        const Affine modelFromWorld{glm::inverse(glm::dmat4(instance.worldFromModel))};
        const glm::dvec3 hit = glm::dvec3(ray.origin) + double{found.t} * glm::dvec3(ray.direction);
        const glm::dvec3 point = modelFromWorld * glm::dvec4(hit, 1.0);
        const glm::dvec3 nearest = glm::clamp(point, glm::dvec3(found.voxel), glm::dvec3(found.voxel + 1));
        const glm::dvec3 apart = glm::dmat3(instance.worldFromModel) * (point - nearest);
        return glm::length(apart) <= 2.0 * kTieDistance * reachOf(ray);
    }

    /// Some ray beside this one gets as far as tMin.
    bool passesBeside(const FloatRay& ray, double tMin) const {
        Random random(1);
        const double reach = kTieDistance * reachOf(ray);
        for (int i = 0; i < 2048; ++i) {
            ReferenceRay beside = exact(ray);
            beside.origin += random.uniform(0.0, reach) * random.direction();
            beside.direction +=
                random.uniform(0.0, kTieDistance) * glm::length(beside.direction) * random.direction();
            const Answer answer = reference(beside);
            if (!answer || answer->t >= tMin) return true;
        }
        return false;
    }

    /// No ray goes on from here to anything.
    double sceneEnd(const FloatRay& ray) const {
        return reachOf(ray) / glm::length(glm::dvec3(ray.direction));
    }

    /// Nothing solid on the ray behind tFirst: what begins there is over at once.
    bool meetsOnlyCorners(const FloatRay& ray, double tFirst, double tEnd) const {
        const double tStep = kTieDistance * reachOf(ray) / glm::length(glm::dvec3(ray.direction));
        for (double t = tFirst + 2.0 * tStep; t < tEnd; t += tStep) {
            const glm::dvec3 point = glm::dvec3(ray.origin) + t * glm::dvec3(ray.direction);
            for (const Instance& instance : asset_.instances) {
                const Affine modelFromWorld{glm::inverse(glm::dmat4(instance.worldFromModel))};
                const glm::dvec3 voxel = glm::floor(modelFromWorld * glm::dvec4(point, 1.0));
                if (!instance.hidden && asset_.models[instance.model].at(glm::ivec3(voxel))) return false;
            }
        }
        return true;
    }

    double reachOf(const FloatRay& ray) const {
        const double farEnd =
            glm::length(glm::dvec3(ray.origin) - box_.center()) + box_.radius() + glm::length(box_.center());
        return std::max(farEnd, largestCube_);
    }

    /// The hit point may lie off by the tie distance across the face.
    bool sameDistance(const gpu::GpuHit& found, const ReferenceHit& expected, const FloatRay& ray) const {
        if (expected.face == Face::Inside) return found.t == 0.0f;
        const double cosine = std::max(cosineOf(ray, expected.normal), 1e-6);
        const double apart = std::abs(found.t - expected.t) * glm::length(glm::dvec3(ray.direction));
        return apart <= 2.0 * kTieDistance * reachOf(ray) / cosine;
    }

    static bool sameNormal(const gpu::GpuHit& found, const ReferenceHit& expected) {
        return expected.face == Face::Inside ||
               glm::length(glm::dvec3(found.normal) - expected.normal) < 1e-4;
    }

    const OctreeAsset& asset_;
    ReferenceCaster caster_;
    WorldBox box_;
    double largestCube_ = 0.0;  ///< edge in the world of what the GPU takes for the unit cube
};

std::string describe(const FloatRay& ray, const gpu::GpuHit& found, const Answer& expected) {
    std::ostringstream text;
    text.precision(9);
    const auto vec = [&](auto v) { text << " (" << v.x << ", " << v.y << ", " << v.z << ")"; };
    text << "ray";
    vec(ray.origin);
    vec(ray.direction);
    text << "\n  GPU:";
    if (found.hit) {
        text << " instance " << found.instance << " voxel";
        vec(found.voxel);
        text << " face " << int{found.face} << " material " << found.material << " t " << found.t;
    } else {
        text << " miss";
    }
    text << "\n  reference:";
    if (expected) {
        text << " instance " << expected->instance << " voxel";
        vec(expected->voxel);
        text << " face " << static_cast<int>(expected->face) << " material " << expected->material << " t "
             << expected->t;
    } else {
        text << " miss";
    }
    return text.str();
}

std::vector<gpu::GpuHit> castOnGpu(gpu::Device& device, std::span<const gpu::ScenePart> parts,
                                   std::span<const FloatRay> rays) {
    std::vector<gpu::GpuRay> gpuRays;
    for (const FloatRay& ray : rays) gpuRays.push_back({.origin = ray.origin, .direction = ray.direction});
    DiagnosticList diagnostics;
    const auto cast = [&]() -> Result<gpu::RayBatch> {
        PFVOX_TRY(const gpu::Scene, scene, gpu::Scene::build(device, parts, diagnostics));
        PFVOX_TRY(const gpu::RayQuery, query, gpu::RayQuery::create(device));
        return query.cast(device, scene, gpuRays, gpu::RayMode::ClosestHit);
    };
    Result<gpu::RayBatch> batch = cast();
    if (!batch) {
        ADD_FAILURE() << pfvox::describe(batch.error());
        return {};
    }
    return std::move(batch->hits);
}

}  // namespace

std::vector<RayFamily> rayFamilies(Random& random, const OctreeAsset& asset, std::size_t raysPerFamily) {
    RayMaker maker(random, asset);
    const auto family = [&](const char* name, FloatRay (RayMaker::*make)()) {
        RayFamily made{.name = name, .rays = {}};
        for (std::size_t i = 0; i < raysPerFamily; ++i) made.rays.push_back((maker.*make)());
        return made;
    };
    return {family("random", &RayMaker::random),
            family("axis-parallel", &RayMaker::axisParallel),
            family("corners and edges", &RayMaker::cornerOrEdge),
            family("from inside", &RayMaker::fromInside),
            family("grazing", &RayMaker::grazing),
            family("from far", &RayMaker::fromFar)};
}

Comparison compare(gpu::Device& device, const OctreeAsset& asset, std::span<const FloatRay> rays) {
    const gpu::ScenePart part{.asset = &asset};
    return compare(device, {&part, 1}, asset, rays);
}

Comparison compare(gpu::Device& device, std::span<const gpu::ScenePart> parts, const OctreeAsset& asset,
                   std::span<const FloatRay> rays) {
    const std::vector<gpu::GpuHit> hits = castOnGpu(device, parts, rays);
    const Judge judge(asset);
    enum class Verdict : std::uint8_t { Same, Tie, Disagreement };
    std::vector<Verdict> verdicts(hits.size());
    std::vector<std::uint8_t> isHit(hits.size());
    tbb::parallel_for(std::size_t{0}, hits.size(), [&](std::size_t i) {
        const Answer expected = judge.reference(judge.exact(rays[i]));
        isHit[i] = expected.has_value();
        if (judge.same(hits[i], expected, rays[i])) return;
        verdicts[i] = judge.isTie(hits[i], expected, rays[i]) ? Verdict::Tie : Verdict::Disagreement;
    });

    Comparison counts;
    counts.rays = hits.size();
    for (std::size_t i = 0; i < hits.size(); ++i) {
        counts.hits += isHit[i];
        counts.stepLimitReached += hits[i].stepLimitReached ? 1u : 0u;
        counts.ties += verdicts[i] == Verdict::Tie ? 1u : 0u;
        if (verdicts[i] == Verdict::Disagreement && counts.disagreements++ == 0) {
            counts.firstDisagreement = describe(rays[i], hits[i], judge.reference(judge.exact(rays[i])));
        }
    }
    return counts;
}

}  // namespace pfvox::test
