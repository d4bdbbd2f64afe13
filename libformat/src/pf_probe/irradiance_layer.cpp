#include <algorithm>
#include <pfvox/assert.hpp>
#include <pfvox/probe_layers.hpp>

#include "pf_probe/bilinear_fit.hpp"
#include "pf_probe/layer_maths.hpp"
#include "shared/probe_maths.glsl.h"

namespace pfvox {

namespace {

/// The cosine changes so slowly that blocks of some 4 degrees stand for their texels.
constexpr std::uint32_t kMaxQuadratureEdge = 64;
/// Normals at which E is computed, along a texel of the layer: what the lookup does between its texels must
/// show.
constexpr std::uint32_t kSamplesPerTexel = 4;

/// Radiance times solid angle, summed over each block of texels.
struct Flux {
    std::vector<glm::dvec3> directions;
    std::vector<glm::dvec3> flux;
    std::vector<double> solidAngles;
};

Flux sumFlux(const RadianceMap& radiance) {
    const std::uint32_t block = probe::blockEdgeOf(radiance.edge, kMaxQuadratureEdge);
    const std::uint32_t edge = radiance.edge / block;
    Flux sums{.directions = probe::texelDirections(edge), .flux = {}, .solidAngles = {}};
    sums.flux.resize(sums.directions.size());
    sums.solidAngles.resize(sums.directions.size());
    for (std::uint32_t y = 0; y < radiance.edge; ++y)
        for (std::uint32_t x = 0; x < radiance.edge; ++x) {
            const double solidAngle = probe::solidAngleOf(x, y, radiance.edge);
            const std::size_t to = x / block + std::size_t{edge} * (y / block);
            sums.flux[to] += glm::dvec3(radiance.texels[x + std::size_t{radiance.edge} * y]) * solidAngle;
            sums.solidAngles[to] += solidAngle;
        }
    return sums;
}

/// E / pi. Divided by the sum of the weights rather than by pi: white light gives exactly 1.
glm::dvec3 irradianceOver(const Flux& sums, glm::dvec3 normal) {
    glm::dvec3 sum{0};
    double weights = 0;
    for (std::size_t i = 0; i < sums.flux.size(); ++i) {
        const double cosine = std::max(0.0, glm::dot(sums.directions[i], normal));
        sum += cosine * sums.flux[i];
        weights += cosine * sums.solidAngles[i];
    }
    return weights > 0 ? sum / weights : glm::dvec3{0};
}

}  // namespace

std::vector<std::uint32_t> irradianceLayer(const RadianceMap& radiance, std::uint32_t interior) {
    PFVOX_ASSERT(radiance.texels.size() == std::size_t{radiance.edge} * radiance.edge);
    const Flux sums = sumFlux(radiance);
    const std::uint32_t sampleResolution = kSamplesPerTexel * interior;
    std::array<std::vector<double>, 3> values;
    for (const glm::dvec3 normal : probe::texelDirections(sampleResolution)) {
        const glm::dvec3 e = irradianceOver(sums, normal);
        for (std::size_t c = 0; c < 3; ++c) values[c].push_back(e[static_cast<int>(c)]);
    }
    const probe::BilinearFit fit(interior, sampleResolution);
    const std::array<std::vector<double>, 3> fitted{
        fit.fitNonNegative(values[0]), fit.fitNonNegative(values[1]), fit.fitNonNegative(values[2])};
    std::vector<std::uint32_t> words;
    for (std::size_t i = 0; i < fitted[0].size(); ++i)
        words.push_back(shared::packLight(glm::vec3{glm::dvec3{fitted[0][i], fitted[1][i], fitted[2][i]}}));
    return probe::withBorder(words, interior);
}

glm::vec3 lookupIrradiance(std::span<const std::uint32_t> words, std::uint32_t interior, glm::vec3 normal) {
    const probe::Footprint f = probe::footprintOf(glm::dvec3{normal}, interior);
    glm::dvec3 sum{0};
    for (std::size_t k = 0; k < 4; ++k) {
        const std::uint32_t x = f.texel[k] % interior + 1;
        const std::uint32_t y = f.texel[k] / interior + 1;
        sum += f.weight[k] * glm::dvec3(shared::unpackLight(words[x + (interior + 2) * y]));
    }
    return glm::vec3{sum};
}

}  // namespace pfvox
