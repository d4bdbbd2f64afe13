#include "bake/probe_maps.hpp"

#include <limits>
#include <pfvox/probe_layers.hpp>
#include <pfvox/probe_maths.hpp>

#include "filter/light_filter.hpp"

namespace pfvox::bake {

namespace {

std::vector<glm::vec3> storedLight(const TracedProbe& traced, const MapSettings& settings) {
    if (settings.filterVoxelMetres <= 0.0f) return traced.light;
    return filter::filterLight({.words = traced.words,
                                .metres = traced.metres,
                                .depthResolution = traced.resolution.depth,
                                .light = traced.light,
                                .lightResolution = traced.resolution.light,
                                .errors = traced.errors,
                                .voxelMetres = settings.filterVoxelMetres},
                               {});
}

}  // namespace

ProbeData makeMaps(const TracedProbe& traced, const MapSettings& settings) {
    const ProbeResolution& resolution = settings.resolution;
    ProbeData data;
    if (resolution.depth != 0) {
        data.depthNormal = traced.words;
        data.minDepth = minDepthLayer(data.depthNormal, resolution.depth);
    }
    if (resolution.light != 0) {
        data.light.reserve(traced.light.size());
        for (const glm::vec3& light : storedLight(traced, settings)) data.light.push_back(packLight(light));
    }
    if (resolution.irradiance != 0)
        data.irradiance = irradianceLayer({.edge = traced.resolution.light, .texels = traced.leaving},
                                          resolution.irradiance);
    if (resolution.moments != 0) {
        std::vector<float> metres = traced.metres;
        for (float& distance : metres)
            if (distance < 0.0f) distance = std::numeric_limits<float>::infinity();
        data.moments = momentsLayer({.edge = traced.resolution.depth, .texels = metres}, settings.momentRange,
                                    resolution.moments);
    }
    return data;
}

}  // namespace pfvox::bake
