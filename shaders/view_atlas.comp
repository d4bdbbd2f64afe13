// Pages of the atlas: maps of probes side by side, row 0 of a map at its top.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

#include "view_frame.glsl"
#include "view_colors.glsl"
#include "probe_field.glsl"

const vec3 kNothingThere = vec3(0.03, 0.07, 0.25);  // texels that see the sky

// Without a light map: the irradiance map, which every file for pictures has.
vec3 lightTexel(ViewParameters view, ProbeFieldRecord field, ProbeEntry probe, vec2 at) {
    uint word;
    if (field.lightResolution != 0u) {
        uvec2 texel = min(uvec2(at * float(field.lightResolution)), uvec2(field.lightResolution - 1u));
        word = ProbeWords(probe.light).at[texel.x + field.lightResolution * texel.y];
    } else {
        if (field.irradianceResolution == 0u) return kBackground;
        uvec2 texel = min(uvec2(at * float(field.irradianceResolution)), uvec2(field.irradianceResolution - 1u)) + 1u;
        word = ProbeWords(probe.irradiance).at[texel.x + (field.irradianceResolution + 2u) * texel.y];
    }
    return toneMap(view.toneMap, view.exposure * unpackLight(word));
}

vec3 texelColor(ViewParameters view, ProbeFieldRecord field, ProbeEntry probe, vec2 at) {
    if (view.mode == kViewAtlasLight) return lightTexel(view, field, probe, at);
    uvec2 texel = min(uvec2(at * float(field.depthResolution)), uvec2(field.depthResolution - 1u));
    uint word = ProbeWords(probe.depthNormal).at[texel.x + field.depthResolution * texel.y];
    if (isMiss(word)) return kNothingThere;
    if (view.mode == kViewAtlasNormals) return linearFromSrgb(0.5 + 0.5 * normalOf(word));
    return linearFromSrgb(vec3(1.0 - float(depthCodeOf(word)) / float(kMaxDepthCode)));
}

// Stripes where a probe is inactive: it has no maps.
vec3 atlasColor(ViewParameters view, vec2 position) {
    uvec2 cell = uvec2(position) / view.atlasCell;
    uint number = cell.x + view.atlasColumns * cell.y;
    vec2 at = (position - vec2(cell * view.atlasCell)) / max(float(view.atlasCell) - 1.0, 1.0);
    if (cell.x >= view.atlasColumns || number >= view.atlasCount || any(greaterThanEqual(at, vec2(1.0)))) return kBackground;
    ProbeFieldRecord field = ProbeFieldRef(view.field).field;
    ProbeEntry probe = ProbeEntries(field.probes).at[view.atlasFirst + number];
    if (probe.isActive == 0u) return fract(4.0 * (at.x + at.y)) < 0.5 ? vec3(0.20, 0.02, 0.02) : kBackground;
    return texelColor(view, field, probe, at);
}

void main() {
    ViewParameters view = Parameters(push.parameters).view;
    Pixel pixel = pixelOf(view);
    if (!pixel.inside) return;
    vec2 position = vec2(pixel.at) + samplePosition(sampleNumber(view));
    writeColor(view, pixel.index, atlasColor(view, position), kInfinity);
}
