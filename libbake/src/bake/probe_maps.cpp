#include "bake/probe_maps.hpp"

#include <limits>
#include <pfvox/probe_layers.hpp>
#include <pfvox/probe_maths.hpp>

namespace pfvox::bake {

namespace {

std::vector<glm::vec3> leavingRadiance(const TracedProbe& traced) {
    const TracedEdges e = traced.edges;
    const std::uint32_t block = e.depth / e.light;
    std::vector<glm::vec3> radiance(traced.light.size());
    const float share = 1.0f / static_cast<float>(block * block);
    for (std::uint32_t y = 0; y < e.depth; ++y) {
        for (std::uint32_t x = 0; x < e.depth; ++x) {
            const shared::SeenTexel& seen = traced.seen[x + std::size_t{e.depth} * y];
            const std::size_t to = x / block + std::size_t{e.light} * (y / block);
            radiance[to] += share * (seen.direct + seen.albedo * traced.light[to]);
        }
    }
    return radiance;
}

std::vector<float> distances(const TracedProbe& traced) {
    std::vector<float> metres;
    metres.reserve(traced.seen.size());
    for (const shared::SeenTexel& seen : traced.seen)
        metres.push_back(seen.metres >= 0.0f ? seen.metres : std::numeric_limits<float>::infinity());
    return metres;
}

}  // namespace

ProbeData makeMaps(const TracedProbe& traced, const ProbeResolution& resolution, float momentRange) {
    ProbeData data;
    if (resolution.depth != 0) {
        data.depthNormal.reserve(traced.seen.size());
        for (const shared::SeenTexel& seen : traced.seen) data.depthNormal.push_back(seen.word);
        data.minDepth = minDepthLayer(data.depthNormal, resolution.depth);
    }
    if (resolution.light != 0)
        for (const glm::vec3& light : traced.light) data.light.push_back(packLight(light));
    if (resolution.irradiance != 0)
        data.irradiance =
            irradianceLayer({.edge = traced.edges.light, .texels = leavingRadiance(traced)}, resolution.irradiance);
    if (resolution.moments != 0) {
        const std::vector<float> metres = distances(traced);
        data.moments = momentsLayer({.edge = traced.edges.depth, .texels = metres}, momentRange, resolution.moments);
    }
    return data;
}

}  // namespace pfvox::bake
