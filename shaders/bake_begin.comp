// The first vertex of a wave's paths: a surface that the texel sees. Light there is I = E / pi, the mean of the
// radiance that comes in over cosine-distributed directions; the sun counts from the next vertex on.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

#include "bake_paths.glsl"

uint bitOfRank(uint mask, uint rank) {
    for (uint i = 0u; i < rank; ++i) mask &= mask - 1u;
    return uint(findLSB(mask));
}

// Samples go round the surfaces under the texel.
struct PathStart {
    vec3 origin;
    vec3 normal;
};
PathStart startOfSample(BakeWave wave, uint probe, uvec2 texel, uint mask, uint sampleIndex) {
    uint block = wave.depthResolution / wave.lightResolution;
    uint bit = bitOfRank(mask, sampleIndex % uint(bitCount(mask)));
    uvec2 at = texel * block + uvec2(bit & 3u, bit >> 2);
    SeenTexel seen = SeenTexels(wave.texels).at[seenIndex(wave, probe, at)];
    vec3 position = Probes(wave.probes).at[probe].position + seen.metres * directionOfTexel(at.x, at.y, wave.depthResolution);
    return PathStart(position + seen.lift, unpackWideNormal(seen.normal));
}

void main() {
    uint path = invocationIndex();
    BakeWave wave = Waves(push.wave).at[0];
    BakeScene bake = BakeScenes(wave.scene).at[0];
    uint mask = 0u;
    uint probe = 0u;
    uvec2 texel = uvec2(0u);
    uvec2 item = uvec2(0u);
    if (path < push.count * kItemPaths) {
        item = Items(wave.items).at[path / kItemPaths];
        texel = texelOfTile(wave, item.x, path % kTileTexels);
        probe = probeOfTile(wave, item.x);
        mask = surfacesUnder(wave, probe, texel);
        Vectors(wave.arrived).at[path] = vec4(0.0);
    }
    bool alive = mask != 0u;
    ShadowRay shadow = ShadowRay(vec3(0.0), 0.0, vec3(0.0), path, vec3(0.0), 0.0);
    if (alive) {
        uint sampleIndex = item.y * kBatchSamples + path / kTileTexels % kBatchSamples;
        uint key = texelKey(bake.seedLow, bake.seedHigh, Probes(wave.probes).at[probe].index,
                            texel.x + wave.lightResolution * texel.y);
        PathStart start = startOfSample(wave, probe, texel, mask, sampleIndex);
        if (looksForEmitters(bake)) {
            Lobes white = Lobes(vec3(1.0), vec3(0.0), 0.0, 1.0, 0.0);
            float pick = randomPair(key, 0u, kPairEmitterAndLobe, sampleIndex).x;
            vec2 u = randomPair(key, 0u, kPairEmitterPoint, sampleIndex);
            shadow = towardsEmitter(bake, white, start.origin, start.normal, start.normal, pick, u);
            shadow.path = path;
        }
        vec3 local = cosineDirection(randomPair(key, 0u, kPairDirection, sampleIndex));
        vec3 direction = inFrame(local, start.normal);
        Paths(wave.paths).at[path] = PathState(start.origin, local.z / kPi, direction, 0.0, vec3(1.0), 0u, kNoMaterial, key,
                                               sampleIndex, 0u);
    }
    queueRay(wave, push.set, alive, path);
    queueShadowRay(wave, push.set, kQueueEmitters, shadow);
}
