#include "bake/probe_maps.hpp"

#include <limits>
#include <pfvox/probe_layers.hpp>
#include <pfvox/probe_maths.hpp>

namespace pfvox::bake {

ProbeData makeMaps(const TracedProbe& traced, const ProbeResolution& resolution, float momentRange) {
    ProbeData data;
    if (resolution.depth != 0) {
        data.depthNormal = traced.words;
        data.minDepth = minDepthLayer(data.depthNormal, resolution.depth);
    }
    if (resolution.light != 0) {
        data.light.reserve(traced.light.size());
        for (const glm::vec3& light : traced.light) data.light.push_back(packLight(light));
    }
    if (resolution.irradiance != 0)
        data.irradiance = irradianceLayer({.edge = traced.edges.light, .texels = traced.leaving}, resolution.irradiance);
    if (resolution.moments != 0) {
        std::vector<float> metres = traced.metres;
        for (float& distance : metres)
            if (distance < 0.0f) distance = std::numeric_limits<float>::infinity();
        data.moments = momentsLayer({.edge = traced.edges.depth, .texels = metres}, momentRange, resolution.moments);
    }
    return data;
}

}  // namespace pfvox::bake
