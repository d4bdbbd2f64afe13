#include "support/reference_light.hpp"
#include "support/reference_caster.hpp"

#include <cmath>
#include <numbers>

#include "shared/color.glsl.h"
#include "support/procedural.hpp"

namespace pfvox::test {

namespace {

class Tracer {
  public:
    explicit Tracer(const LoadedScene& scene)
        : scene_(scene), asset_(*scene.parts.front().asset), caster_(asset_) {}

    glm::dvec3 path(glm::dvec3 position, glm::dvec3 normal, int bounces) {
        glm::dvec3 light(0.0);
        glm::dvec3 throughput(1.0);
        for (int bounce = 0;; ++bounce) {
            const glm::dvec3 direction = aboveSurface(normal);
            const glm::dvec3 origin = position + 1e-6 * normal;
            const auto hit = caster_.cast({.origin = origin, .direction = direction});
            if (!hit) return light + throughput * sky(direction);
            const Material& m = asset_.materials[hit->material];
            const glm::dvec3 albedo = shared::linearFromSrgb(glm::dvec3(m.baseColor) / 255.0);
            light += throughput * albedo * static_cast<double>(m.emissionStrength);
            if (bounce == bounces) return light;
            position = origin + hit->t * direction;
            normal = hit->normal;
            throughput *= albedo;
            light += throughput * sunOverPi(position, normal);
        }
    }

  private:
    /// Cosine-distributed: a point on the sphere that touches the surface.
    glm::dvec3 aboveSurface(const glm::dvec3& normal) {
        const glm::dvec3 d = normal + random_.direction();
        return glm::dot(d, d) > 1e-12 ? glm::normalize(d) : normal;
    }
    glm::dvec3 sky(const glm::dvec3& direction) const {
        const Sky& s = scene_.scene.sky;
        if (direction.y >= 0.0) return glm::mix(s.horizon, s.zenith, std::sqrt(direction.y));
        const double t = std::min(-direction.y / 0.9, 1.0);
        return glm::mix(s.horizon, s.ground, t * t * (3.0 - 2.0 * t));
    }
    glm::dvec3 sunOverPi(const glm::dvec3& position, const glm::dvec3& normal) const {
        const glm::dvec3 toSun = -glm::normalize(scene_.scene.sun.direction);
        const double cosine = glm::dot(normal, toSun);
        if (cosine <= 0.0 || caster_.cast({.origin = position + 1e-6 * normal, .direction = toSun}))
            return glm::dvec3(0.0);
        return scene_.scene.sun.irradiance * cosine / std::numbers::pi;
    }

    const LoadedScene& scene_;
    const OctreeAsset& asset_;
    ReferenceCaster caster_;
    Random random_{12345};
};

}  // namespace

ReferenceLight referenceLight(const LoadedScene& scene, const glm::dvec3& position, const glm::dvec3& normal,
                              int paths, int bounces) {
    Tracer tracer(scene);
    ReferenceLight result;
    double squares = 0.0;
    double sum = 0.0;
    for (int i = 0; i < paths; ++i) {
        const glm::dvec3 light = tracer.path(position, normal, bounces);
        const double mean = (light.x + light.y + light.z) / 3.0;
        result.mean += light / static_cast<double>(paths);
        sum += mean;
        squares += mean * mean;
    }
    const double mean = sum / paths;
    result.error = std::sqrt(std::max(squares / paths - mean * mean, 0.0) / (paths - 1.0));
    return result;
}

}  // namespace pfvox::test
