// Indirect light at a surface point from a probe field: I = E / pi, never without a value where any probe is active.
//
//     tier 1  texels that see this very surface, of the cell's probes or of the eight around
//     tier 3  the eight probes around, by their irradiance and moments (Majercik et al. 2019, "Dynamic Diffuse Global
//             Illumination with Ray-Traced Irradiance Fields"); outside of the grid more of them, as eight may all be
//             in something
//     tier 4  the nearest active probe
//
// Tiers are blended by how well the texels agree. Tier 2, tracing through the field, is probe_trace.glsl: it answers
// secondary rays, whose surface point comes back here.
#ifndef PFVOX_PROBE_LOOKUP_GLSL
#define PFVOX_PROBE_LOOKUP_GLSL

#include "probe_field.glsl"

const float kCompactWeightFloor = 1e-4;
const float kSeenEnough = 0.1;  // of the eight probes around, by their trilinear weights
const int kWideSteps = 2;
const float kPlaneVoxels = 0.25;       // how far a texel's surface may lie off the plane of the point
const float kPlaneSlackFraction = 1e-3;   // of the distance to the plane: depth codes are no finer
const float kMixedTexelWeight = 0.05;
const float kLeastTexelWeight = 0.02;  // of a neighbor that lies on the point's own texel's border
const float kMuchUnseen = 0.5;
const float kFacingAway = -0.1;
const float kFlattest = 0.2;  // cosine
const float kTexelConfidence = 4.0;    // a quarter of a texel's width that agrees is as good as all of it

struct ProbeLight {
    vec3 indirect;
    vec3 weights;  // of tiers 1, 3 and 4; they sum to 1, or all are 0
    uint tier;     // the heaviest
};

// ---- Tier 1 ----

struct SurfacePoint {
    vec3 position;
    vec3 normal;
    float spread;  // edge of a level of detail, whose surfaces lie anywhere within it; 0 = the point is on its surface
};

// Whether a depth texel shows a surface within a level of detail: one that does not face away from the viewer, as near as
// the node is large. The node's own face says nothing of the planes in it.
bool showsNode(ProbeFieldRecord field, ProbeEntry probe, SurfacePoint point, uint x, uint y) {
    uint word = ProbeWords(probe.depthNormal).at[x + field.depthResolution * y];
    if (isMiss(word)) return false;
    vec3 normal = normalOf(word);
    if (dot(normal, point.normal) < kFacingAway) return false;
    vec3 direction = directionOfTexel(x, y, field.depthResolution);
    float metres = metresOfCode(field, depthCodeOf(word));
    vec3 apart = probe.position + metres * direction - point.position;
    float slack = point.spread + kPlaneVoxels * field.voxelMetres;
    float footprint = texelAngle(field.depthResolution) * metres / max(-dot(direction, normal), kFlattest);
    return abs(dot(apart, normal)) < slack && dot(apart, apart) < (2.0 * slack + footprint) * (2.0 * slack + footprint);
}

// Fraction of the depth texels under one light texel that show the plane of the surface. Each is asked where its own ray
// meets that plane, so that the slope of the surface does not matter and planes a voxel apart stay apart.
float agreementOf(ProbeFieldRecord field, ProbeEntry probe, SurfacePoint point, ivec2 lightTexel) {
    float height = dot(point.position - probe.position, point.normal);  // of the plane, as the probe sees it
    if (height >= 0.0 && point.spread <= 0.0) return 0.0;
    uint block = max(field.depthResolution / field.lightResolution, 1u);
    float tolerance = max(kPlaneVoxels * field.voxelMetres, kPlaneSlackFraction * -height);
    uint packed = packNormal(point.normal);
    uint agreeing = 0u;
    for (uint i = 0u; i < block * block; ++i) {
        uint x = min(uint(lightTexel.x) * block + i % block, field.depthResolution - 1u);
        uint y = min(uint(lightTexel.y) * block + i / block, field.depthResolution - 1u);
        if (point.spread > 0.0) {
            agreeing += uint(showsNode(field, probe, point, x, y));
            continue;
        }
        uint word = ProbeWords(probe.depthNormal).at[x + field.depthResolution * y];
        if (isMiss(word)) continue;
        if (word >> 16 != packed && dot(normalOf(word), point.normal) <= kSurfaceMinNormalDot) continue;
        float cosine = dot(directionOfTexel(x, y, field.depthResolution), point.normal);
        if (abs(metresOfCode(field, depthCodeOf(word)) * cosine - height) < tolerance) ++agreeing;
    }
    return float(agreeing) / float(block * block);
}

// What a texel of mixed planes shows is a mixture of their light: it counts where there is nothing better.
float purityWeight(float purity) { return purity >= 1.0 ? 1.0 : kMixedTexelWeight * purity; }

// Light of the texels around the direction to the point, those only that agree; w = how far they do, 0 to 1.
vec4 lightSeenBy(ProbeFieldRecord field, ProbeEntry probe, SurfacePoint point) {
    vec2 at = texelCoordinate(point.position - probe.position, field.lightResolution) - 0.5;
    ivec2 low = ivec2(floor(at));
    vec2 fraction = at - vec2(low);
    vec4 sum = vec4(0.0);
    float covered = 0.0;
    for (int i = 0; i < 4; ++i) {
        ivec2 offset = ivec2(i & 1, i >> 1);
        ivec2 texel = wrappedTexel(low + offset, field.lightResolution);
        float purity = agreementOf(field, probe, point, texel);
        if (purity <= 0.0) continue;
        vec2 near = max(mix(1.0 - fraction, fraction, vec2(offset)), vec2(kLeastTexelWeight));
        float weight = near.x * near.y * purityWeight(purity);
        uint word = ProbeWords(probe.light).at[uint(texel.x) + field.lightResolution * uint(texel.y)];
        sum += weight * vec4(unpackLight(word), 1.0);
        covered += near.x * near.y * (purity >= 1.0 ? 1.0 : 0.25 * purity * purity);
    }
    return sum.w > 0.0 ? vec4(sum.rgb / sum.w, min(kTexelConfidence * covered, 1.0)) : vec4(0.0);
}

// One read instead of all that lightSeenBy asks: most of the eight probes around see other things.
bool ownTexelSees(ProbeFieldRecord field, ProbeEntry probe, SurfacePoint point) {
    vec3 toPoint = point.position - probe.position;
    if (dot(toPoint, toPoint) < 1e-12) return false;
    uint texel = texelIndex(toPoint, field.depthResolution);
    if (point.spread > 0.0) return showsNode(field, probe, point, texel % field.depthResolution, texel / field.depthResolution);
    uint word = ProbeWords(probe.depthNormal).at[texel];
    return seesSurface(word, toPoint, point.normal, field.depthResolution, field.depthScaleAndLogRange);
}

struct TexelSum {
    vec4 weighed;  // I times weight; the weights
    float unseen;
};

void addTexelsOf(ProbeFieldRecord field, ProbeEntry probe, SurfacePoint point, inout TexelSum sum) {
    vec4 seen = lightSeenBy(field, probe, point);
    if (seen.w <= 0.0) return;
    vec3 toPoint = point.position - probe.position;
    float squared = max(dot(toPoint, toPoint), 1e-8);
    // Texels a square metre of the surface.
    float cosine = -dot(toPoint, point.normal) * inversesqrt(squared);
    float weight = seen.w * max(cosine, point.spread > 0.0 ? kFlattest : 0.0) / squared;
    sum.weighed += weight * vec4(seen.rgb, 1.0);
    sum.unseen *= 1.0 - seen.w;
}

// The list of the cell that the surface is in. That of a level of detail may lie behind the node's face.
uint listOf(ProbeFieldRecord field, SurfacePoint point) {
    uint list = proximityListOf(field, point.position, point.normal);
    if (point.spread <= 0.0) return list;
    for (uint i = 1u; i <= 2u; ++i) {
        if (list != kNoProbeIndex && ProbeWords(field.cells).at[list] != kNoProbeIndex) break;
        list = proximityListOf(field, point.position - 0.5 * float(i) * point.spread * point.normal, point.normal);
    }
    return list;
}

// Of the probes that the cell names; where they do not see the point, of the eight around. One loop for both: drivers unroll
// what they inline, and lightSeenBy is long.
vec4 lightOfTexels(ProbeFieldRecord field, SurfacePoint point) {
    if (field.lightResolution == 0u || field.depthResolution == 0u) return vec4(0.0);
    uint list = listOf(field, point);
    if (list == kNoProbeIndex) return vec4(0.0);
    ivec3 cell = probeCellOf(field, point.position);
    TexelSum sum = TexelSum(vec4(0.0), 1.0);
    for (uint k = 0u; k < kProbesOfCell + 8u; ++k) {
        bool named = k < kProbesOfCell;
        if (!named && sum.unseen <= kMuchUnseen) break;
        uint corner = k - kProbesOfCell;
        if (!named && !cornerExists(field, corner)) continue;
        uint index = named ? ProbeWords(field.cells).at[list + k] : probeIndexAt(field, cell + cornerOffset(corner));
        if (index == kNoProbeIndex) continue;
        ProbeEntry probe = ProbeEntries(field.probes).at[index];
        if (probe.isActive == 0u) continue;
        if (named || ownTexelSees(field, probe, point)) addTexelsOf(field, probe, point, sum);
    }
    return sum.weighed.w > 0.0 ? vec4(sum.weighed.rgb / sum.weighed.w, 1.0 - sum.unseen) : vec4(0.0);
}

// ---- Tiers 3 and 4 ----

// Words of a map with border, around the coordinate of a direction; weights as a bilinear read has them.
struct BilinearRead {
    uint index;   // of the lower texel
    uint rowStep;
    vec2 fraction;
};
BilinearRead bilinearRead(vec3 direction, uint interior) {
    vec2 at = borderedCoordinate(direction, interior) - 0.5;
    ivec2 low = clamp(ivec2(floor(at)), ivec2(0), ivec2(interior));
    uint resolution = interior + 2u;
    return BilinearRead(uint(low.x) + resolution * uint(low.y), resolution, clamp(at - vec2(low), vec2(0.0), vec2(1.0)));
}

vec3 irradianceOf(ProbeFieldRecord field, ProbeEntry probe, vec3 normal) {
    BilinearRead r = bilinearRead(normal, field.irradianceResolution);
    ProbeWords words = ProbeWords(probe.irradiance);
    vec3 low = mix(unpackLight(words.at[r.index]), unpackLight(words.at[r.index + 1u]), r.fraction.x);
    uint next = r.index + r.rowStep;
    vec3 high = mix(unpackLight(words.at[next]), unpackLight(words.at[next + 1u]), r.fraction.x);
    return mix(low, high, r.fraction.y);
}

vec2 momentsOf(ProbeFieldRecord field, ProbeEntry probe, vec3 direction) {
    BilinearRead r = bilinearRead(direction, field.momentsResolution);
    ProbeWords words = ProbeWords(probe.moments);
    vec2 low = mix(unpackMoments(words.at[r.index]), unpackMoments(words.at[r.index + 1u]), r.fraction.x);
    uint next = r.index + r.rowStep;
    vec2 high = mix(unpackMoments(words.at[next]), unpackMoments(words.at[next + 1u]), r.fraction.x);
    return mix(low, high, r.fraction.y);
}

// Chebyshev's bound on the fraction of what the lobe sees beyond this distance, made steeper.
float visibilityFrom(ProbeFieldRecord field, ProbeEntry probe, vec3 toPoint) {
    if (field.momentsResolution == 0u) return 1.0;
    float distance = length(toPoint);
    if (distance < 1e-6) return 1.0;
    vec2 moments = momentsOf(field, probe, toPoint);
    float d = min(distance / field.momentRange, 1.0);
    if (d <= moments.x) return 1.0;
    float variance = max(moments.y - moments.x * moments.x, 1e-6);
    float beyond = d - moments.x;
    float bound = variance / (variance + beyond * beyond);
    return bound * bound * bound;
}

float facingWeight(ProbeEntry probe, SurfacePoint point) {
    vec3 toProbe = probe.position - point.position;
    float distance = length(toProbe);
    float facing = distance > 1e-6 ? 0.5 * dot(toProbe, point.normal) / distance + 0.5 : 1.0;
    return facing * facing + 0.2;
}

// Little is made less, or many faint probes behind walls would add up.
float curbed(float weight) { return max(weight < 0.2 ? weight * weight * weight / 0.04 : weight, kCompactWeightFloor); }

// Square roots are blended: one probe beside a lamp or a window does not outshine the seven others.
struct RootSum {
    vec4 weighed;  // roots of I times weight; the weights
    float seen;    // fraction of the neighborhood that sees the point
};

void addProbe(ProbeFieldRecord field, ProbeEntry probe, SurfacePoint point, vec3 biased, float near, inout RootSum sum) {
    if (probe.isActive == 0u) return;
    float visibility = visibilityFrom(field, probe, biased - probe.position);
    float weight = near * curbed(facingWeight(probe, point) * visibility);
    sum.weighed += weight * vec4(sqrt(irradianceOf(field, probe, point.normal)), 1.0);
    sum.seen += near * visibility;
}

// 0 up to half a step outside of the probes, 1 from a whole step on.
float outsideOfProbes(ProbeFieldRecord field, vec3 point) {
    vec3 steps = (point - field.start) / field.step;
    vec3 beyond = max(max(-steps, steps - vec3(field.counts - 1)), vec3(0.0));
    return clamp(2.0 * max(beyond.x, max(beyond.y, beyond.z)) - 1.0, 0.0, 1.0);
}

// Of the eight probes around, trilinear. Outside of the grid these may all stand in something: there of those up to two
// steps further, by distance.
vec4 lightOfGrid(ProbeFieldRecord field, SurfacePoint point) {
    vec3 biased = point.position + min(2.0 * field.voxelMetres, 0.2 * min(field.step.x, min(field.step.y, field.step.z))) * point.normal;
    ivec3 cell = probeCellOf(field, biased);
    ivec3 low = cell;
    ivec3 high = min(cell + 1, field.counts - 1);
    vec3 last = vec3(field.counts - 1);
    vec3 inside = clamp((biased - field.start) / field.step, vec3(0.0), last);
    vec3 root = vec3(0.0);
    bool found = false;
    float fraction = 1.0;  // of this round
    for (uint round = 0u; round < 2u && fraction > 0.0; ++round) {
        RootSum sum = RootSum(vec4(0.0), 0.0);
        for (int z = low.z; z <= high.z; ++z) {
            for (int y = low.y; y <= high.y; ++y) {
                for (int x = low.x; x <= high.x; ++x) {
                    vec3 apart = abs(vec3(x, y, z) - inside);
                    vec3 near = max(1.0 - apart, vec3(0.001));
                    float weight = round == 0u ? near.x * near.y * near.z : exp2(-dot(apart, apart));
                    addProbe(field, ProbeEntries(field.probes).at[probeIndexAt(field, ivec3(x, y, z))], point, biased, weight, sum);
                }
            }
        }
        if (sum.weighed.w > 0.0) root = mix(root, sum.weighed.rgb / sum.weighed.w, found ? fraction : 1.0);
        found = found || sum.weighed.w > 0.0;
        fraction = outsideOfProbes(field, biased) * (1.0 - min(sum.seen / kSeenEnough, 1.0));
        low = max(cell - kWideSteps, ivec3(0));
        high = min(cell + 1 + kWideSteps, field.counts - 1);
    }
    return found ? vec4(root * root, 1.0) : vec4(0.0);
}

vec4 lightOfNearest(ProbeFieldRecord field, SurfacePoint point) {
    ivec3 at = ivec3(round(clamp((point.position - field.start) / field.step, vec3(0.0), vec3(field.counts - 1))));
    uint nearest = ProbeEntries(field.probes).at[probeIndexAt(field, at)].nearestActive;
    if (nearest == kNoProbeIndex) return vec4(0.0);
    return vec4(irradianceOf(field, ProbeEntries(field.probes).at[nearest], point.normal), 1.0);
}

// ---- All of it ----

// `normal` is that of the surface, unit, on the side that is seen. `spread`: edge of a level of detail in metres, else 0.
ProbeLight lookUpProbes(ProbeFieldRecord field, vec3 position, vec3 normal, float spread) {
    SurfacePoint point = SurfacePoint(position, normal, spread);
    vec4 texels = lightOfTexels(field, point);
    vec4 rest = vec4(0.0);
    bool fromGrid = false;
    if (texels.w < 1.0 && field.irradianceResolution != 0u) {
        rest = lightOfGrid(field, point);
        fromGrid = rest.w > 0.0;
        if (!fromGrid) rest = lightOfNearest(field, point);
    }
    float first = rest.w > 0.0 ? texels.w : texels.w > 0.0 ? 1.0 : 0.0;
    ProbeLight light;
    light.indirect = first * texels.rgb + (1.0 - first) * rest.rgb;
    light.weights = vec3(first, fromGrid ? 1.0 - first : 0.0, !fromGrid && rest.w > 0.0 ? 1.0 - first : 0.0);
    light.tier = first > 0.5 ? kTierTexels : fromGrid ? kTierCompact : rest.w > 0.0 ? kTierNearest : kTierNone;
    if (light.tier == kTierNone && texels.w > 0.0) light.tier = kTierTexels;
    return light;
}

#endif
