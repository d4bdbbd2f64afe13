#include "filter/light_filter.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <pfvox/assert.hpp>
#include <pfvox/probe_maths.hpp>

namespace pfvox::filter {

namespace {

constexpr std::array<float, 3> kSpline{6.0f / 16, 4.0f / 16, 1.0f / 16};  // by distance from the middle
constexpr float kMinNormalDot = 0.9f;
constexpr std::size_t kMaxPlanes = 3;
constexpr int kMinPasses = 2;
constexpr int kMaxPasses = 5;

/// A plane that a texel of the light map shows.
struct Plane {
    glm::vec3 position{0.0f};  ///< of the middle of what is seen of it, from the probe, metres
    glm::vec3 normal{0.0f};
    float fraction = 0.0f;  ///< of the depth texels below
};

/// What a texel of the light map shows: the planes of the depth texels below it, the largest first.
struct Patch {
    std::array<Plane, kMaxPlanes> planes{};
    std::size_t planeCount = 0;  ///< 0: nothing, or more than fits
    float footprint = 0.0f;      ///< edge of what the texel covers of the first, metres
};

float brightness(const glm::vec3& c) {
    return (c.x + c.y + c.z) / 3.0f;
}

/// The texel at any distance over the borders of the map: each of them is folded in its middle.
glm::ivec2 wrapped(glm::ivec2 texel, int resolution) {
    if (texel.x < 0 || texel.x >= resolution)
        texel = {texel.x < 0 ? -1 - texel.x : 2 * resolution - 1 - texel.x, resolution - 1 - texel.y};
    if (texel.y < 0 || texel.y >= resolution)
        texel = {resolution - 1 - texel.x, texel.y < 0 ? -1 - texel.y : 2 * resolution - 1 - texel.y};
    return glm::clamp(texel, 0, resolution - 1);
}

class Filter {
  public:
    Filter(const LightMap& map, const LightFilterSettings& settings)
        : map_(map),
          settings_(settings),
          edge_(static_cast<int>(map.lightResolution)),
          light_(map.light.begin(), map.light.end()) {
        findPatches();
        setVariance();
    }

    std::vector<glm::vec3> run() {
        const int passes = passCount();
        for (int pass = 0; pass < passes; ++pass) runPass(1 << pass);
        return std::move(light_);
    }

  private:
    std::size_t indexOf(glm::ivec2 texel) const {
        return static_cast<std::size_t>(texel.x) +
               static_cast<std::size_t>(edge_) * static_cast<std::size_t>(texel.y);
    }

    void findPatches() {
        const std::uint32_t block = map_.depthResolution / map_.lightResolution;
        patches_.resize(light_.size());
        for (std::uint32_t y = 0; y < map_.lightResolution; ++y)
            for (std::uint32_t x = 0; x < map_.lightResolution; ++x)
                patches_[x + std::size_t{map_.lightResolution} * y] = patchOf({x * block, y * block}, block);
    }

    Patch patchOf(glm::uvec2 first, std::uint32_t block) const {
        Patch patch;
        const float part = 1.0f / static_cast<float>(block * block);
        for (std::uint32_t i = 0; i < block * block; ++i) {
            const std::uint32_t x = first.x + i % block;
            const std::uint32_t y = first.y + i / block;
            const std::size_t index = x + std::size_t{map_.depthResolution} * y;
            if (map_.metres[index] < 0.0f) continue;  // paths start from the others only
            const Plane seen{.position = map_.metres[index] * directionOfTexel(x, y, map_.depthResolution),
                             .normal = normalOf(map_.words[index]),
                             .fraction = part};
            if (!addPlane(patch, seen)) return {};
        }
        if (patch.planeCount == 0) return {};
        std::ranges::sort(patch.planes, std::greater{}, &Plane::fraction);
        float sum = 0.0f;
        for (const Plane& plane : patch.planes) sum += plane.fraction;
        for (Plane& plane : patch.planes) plane.fraction /= sum;
        const glm::uvec2 texel = first / block;
        const Plane& largest = patch.planes[0];
        const float metres = glm::length(largest.position);
        const float cosine = std::max(std::abs(glm::dot(largest.position, largest.normal)) / metres, 0.05f);
        patch.footprint =
            metres * std::sqrt(texelSolidAngle(texel.x, texel.y, map_.lightResolution) / cosine);
        return patch;
    }

    /// False when the texel shows more planes than a patch keeps.
    bool addPlane(Patch& patch, const Plane& seen) const {
        for (std::size_t i = 0; i < patch.planeCount; ++i) {
            Plane& plane = patch.planes[i];
            if (!onOnePlane(plane, seen)) continue;
            const float fraction = plane.fraction + seen.fraction;
            plane.position += (seen.fraction / fraction) * (seen.position - plane.position);
            plane.fraction = fraction;
            return true;
        }
        if (patch.planeCount == kMaxPlanes) return false;
        patch.planes[patch.planeCount++] = seen;
        return true;
    }

    bool onOnePlane(const Plane& a, const Plane& b) const {
        const float height = std::abs(glm::dot(b.position - a.position, a.normal));
        return height < settings_.planeVoxels * map_.voxelMetres &&
               glm::dot(a.normal, b.normal) > kMinNormalDot;
    }

    /// How far the light of `b` says something of that of `a`, 0 to 1: by what both show. A texel that shows
    /// one plane takes from its like only, or light would creep from plane to plane through the texels
    /// between them.
    float likeness(const Patch& a, const Patch& b) const {
        if (a.planeCount == 1 && b.planeCount != 1) return 0.0f;
        float common = 0.0f;
        for (std::size_t i = 0; i < a.planeCount; ++i)
            for (std::size_t j = 0; j < b.planeCount; ++j)
                if (onOnePlane(a.planes[i], b.planes[j]))
                    common += std::min(a.planes[i].fraction, b.planes[j].fraction);
        return common * common;
    }

    float reachOf(const Patch& patch) const {
        return std::max(settings_.reachVoxels * map_.voxelMetres, settings_.reachTexels * patch.footprint);
    }

    /// Taps of the last pass lie as far apart as the texels of most of the map reach.
    int passCount() const {
        std::vector<float> texels;
        for (const Patch& patch : patches_)
            if (patch.planeCount != 0) texels.push_back(reachOf(patch) / patch.footprint);
        if (texels.empty()) return kMinPasses;
        const auto middle = texels.begin() + static_cast<std::ptrdiff_t>(texels.size() / 2);
        std::nth_element(texels.begin(), middle, texels.end());
        return std::clamp(static_cast<int>(std::bit_width(static_cast<std::uint32_t>(*middle))), kMinPasses,
                          kMaxPasses);
    }

    /// Of the texels around on the same plane; they differ for the light as well, so it is rather too large.
    float guessedVariance(glm::ivec2 texel) const {
        float sum = 0.0f;
        float squares = 0.0f;
        float count = 0.0f;
        forEachTap<2>(texel, 1, [&](std::size_t to, float) {
            const float value = brightness(light_[to]);
            sum += value;
            squares += value * value;
            count += 1.0f;
        });
        if (count < 2.0f) return 0.0f;
        const float mean = sum / count;
        return std::max(squares / count - mean * mean, 0.0f) * count / (count - 1.0f);
    }

    void setVariance() {
        variance_.resize(light_.size());
        forEachTexel([&](glm::ivec2 texel, std::size_t at) {
            const float error = map_.errors.empty() ? 0.0f : map_.errors[at];
            variance_[at] = error > 0.0f ? error * error : guessedVariance(texel);
        });
    }

    template <class Visit>
    void forEachTexel(const Visit& visit) const {
        for (int y = 0; y < edge_; ++y) {
            for (int x = 0; x < edge_; ++x) {
                const std::size_t at = indexOf({x, y});
                if (patches_[at].planeCount != 0) visit(glm::ivec2{x, y}, at);
            }
        }
    }

    /// Calls `visit` with each tap that shows what the texel shows, itself included, and its weight by that
    /// and by place.
    template <int kRadius, class Visit>
    void forEachTap(glm::ivec2 texel, int step, const Visit& visit) const {
        const Patch& patch = patches_[indexOf(texel)];
        const float reach = reachOf(patch);
        const float inverseReachSquared = 1.0f / (reach * reach);
        const int margin = kRadius * step;
        const bool inside = glm::all(glm::greaterThanEqual(texel, glm::ivec2{margin})) &&
                            glm::all(glm::lessThan(texel, glm::ivec2{edge_ - margin}));
        for (int j = -kRadius; j <= kRadius; ++j) {
            for (int i = -kRadius; i <= kRadius; ++i) {
                const glm::ivec2 place = texel + step * glm::ivec2{i, j};
                const std::size_t to = indexOf(inside ? place : wrapped(place, edge_));
                const Patch& other = patches_[to];
                const float alike = likeness(patch, other);
                if (alike <= 0.0f) continue;
                const glm::vec3 apart = other.planes[0].position - patch.planes[0].position;
                const float near = alike / (1.0f + glm::dot(apart, apart) * inverseReachSquared);
                visit(to, kSpline[static_cast<std::size_t>(std::abs(i))] *
                              kSpline[static_cast<std::size_t>(std::abs(j))] * near * near);
            }
        }
    }

    void runPass(int step) {
        const std::vector<glm::vec3> light = light_;
        const std::vector<float> variance = smoothedVariance();
        const float scale = settings_.noiseScale * settings_.noiseScale;
        std::vector<float> carried(variance_.size());
        forEachTexel([&](glm::ivec2 texel, std::size_t at) {
            glm::vec3 sum{0.0f};
            float weights = 0.0f;
            float squares = 0.0f;
            const float own = brightness(light[at]);
            forEachTap<2>(texel, step, [&](std::size_t to, float near) {
                const float apart = brightness(light[to]) - own;
                const float noise = scale * (variance[at] + variance[to]) + 1e-12f;
                const float alike = noise / (noise + apart * apart);
                const float weight = near * alike * alike;
                sum += weight * light[to];
                weights += weight;
                squares += weight * weight * variance_[to];
            });
            light_[at] = sum / weights;
            carried[at] = squares / (weights * weights);
        });
        variance_ = std::move(carried);
    }

    /// One texel's own figure is too uncertain to decide by.
    std::vector<float> smoothedVariance() const {
        std::vector<float> smooth(variance_.size());
        forEachTexel([&](glm::ivec2 texel, std::size_t at) {
            float sum = 0.0f;
            float weights = 0.0f;
            forEachTap<1>(texel, 1, [&](std::size_t to, float near) {
                sum += near * variance_[to];
                weights += near;
            });
            smooth[at] = sum / weights;
        });
        return smooth;
    }

    const LightMap& map_;
    LightFilterSettings settings_;
    int edge_;
    std::vector<Patch> patches_;
    std::vector<glm::vec3> light_;
    std::vector<float> variance_;
};

}  // namespace

std::vector<glm::vec3> filterLight(const LightMap& map, const LightFilterSettings& settings) {
    PFVOX_ASSERT(map.light.size() == std::size_t{map.lightResolution} * map.lightResolution);
    PFVOX_ASSERT(map.lightResolution != 0 && map.depthResolution % map.lightResolution == 0);
    return Filter(map, settings).run();
}

}  // namespace pfvox::filter
