// Rays from faces. As links: what each of them found that is not light of faces is summed, and the face that it ended on
// kept. Else: light of values, from that of the faces that their rays end on.
//
// A ray goes on through glass and off metal by the baker's own lobes until it ends on a Lambert fraction. At the face, and
// where a ray is reflected by a GGX lobe, emitters are looked for as well (balance heuristic).
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

layout(constant_id = 1) const uint kHasShine = 0u;
layout(constant_id = 2) const uint kMakesLinks = 0u;

#include "face_bake.glsl"

const uint kDirectionNumbers = 1u;
const uint kPointNumbers = 2u;
const uint kPickNumbers = 3u;
const uint kEmitterNumbers = 4u;
const uint kStepNumbers = 5u;

// Numbers behind the first vertex.
uint rayState;
float rayRandom() {
    rayState = rayState * 747796405u + 2891336453u;
    uint word = (rayState >> ((rayState >> 28) + 4u) ^ rayState) * 277803737u;
    return unitFloat(word >> 22 ^ word);
}

struct Found {
    vec3 direct;     // I, without that of faces
    uint face;       // that the ray has ended on
    vec3 weight;     // of the light there
    float lamp;      // metres to an emitter that was seen straight on
    bool counts;     // false: the ray started in a solid voxel
};

// Light of an emitter at a vertex, as its lobes reflect it.
vec3 lightOfEmitter(BakeScene bake, Lobes lobes, vec3 origin, vec3 normal, vec3 toViewer, float pick, vec2 u,
                    out float metres, inout RayCounts counts) {
    metres = kInfinity;
    EmitterSample found = sampleEmitter(bake, origin, pick, u);
    if (maxOf(found.radiance) <= 0.0) return vec3(0.0);
    Scattering s = evaluateLobes(lobes, normal, toViewer, found.toLight);
    if (maxOf(s.value) <= 0.0) return vec3(0.0);
    vec3 way = found.end - origin;
    float length_ = length(way);
    vec3 light = found.radiance * s.value / (found.pdf + s.pdf);
    if (bake.sampling == kSampleEmitters) light = found.radiance * s.value / found.pdf;
    light *= transmittance(Scene(bake.scene), Ray(origin, length_, way / length_, 0.0), counts);
    if (maxOf(light) > 0.0) metres = length_;
    return light;
}

float weightOfEmission(BakeScene bake, float pdf, float travelled, vec3 emission, float cosine) {
    if (pdf < 0.0 || !looksForEmitters(bake)) return 1.0;
    if (bake.sampling == kSampleEmitters) return 0.0;
    return emitterWeight(pdf, emitterPdf(bake, emission, travelled, cosine));
}

// True when glass reflects the ray or lets it go on; false at its Lambert fraction.
bool passGlass(Scene scene, inout Ray ray, inout vec3 throughput, inout float pdf, inout float travelled, inout uint lastGlass,
               Hit hit, Surface surface, MaterialRecord material) {
    bool enters = entersGlass(surface, lastGlass);
    lastGlass = surface.material;
    if (enters) {
        if (rayRandom() < glassReflectance(material, abs(dot(surface.normal, ray.direction)))) {
            ray = Ray(startOf(surface), kInfinity, reflect(ray.direction, surface.normal), 0.0);
            pdf = -1.0;
            lastGlass = kNoMaterial;
            return true;
        }
        if (rayRandom() >= material.transparency) {
            throughput /= max(1.0 - material.transparency, 1e-6);  // lobesOf has the fraction again
            return false;
        }
        throughput *= material.albedo;
    }
    vec3 before = ray.origin;
    ray = behindGlass(scene, ray, hit, surface);
    ray.tMax = kInfinity;
    travelled += distance(before, ray.origin);
    return true;
}

// Where light is looked for: the face, then what reflects the ray by a GGX lobe.
struct Vertex {
    vec3 origin;
    vec3 normal;
    vec3 toViewer;
    Lobes lobes;
};

// Numbers of the face's own vertex come from a sequence, so that rays of a value are even.
struct VertexNumbers {
    float pick;
    vec2 onEmitter;
    vec2 direction;
};
VertexNumbers randomNumbers() {
    float pick = rayRandom();
    vec2 onEmitter = vec2(rayRandom(), rayRandom());
    return VertexNumbers(pick, onEmitter, vec2(rayRandom(), rayRandom()));
}

// Each kind of ray is cast in one place, or the program would be three times as large and half as fast.
Found followRay(BakeScene bake, Vertex vertex, VertexNumbers numbers, uint maxSteps, inout RayCounts counts) {
    Scene scene = Scene(bake.scene);
    Found found = Found(vec3(0.0), kNoFace, vec3(0.0), kInfinity, true);
    vec3 throughput = vec3(1.0);
    float travelled = 0.0;
    float pdf = 0.0;
    uint lastGlass = kNoMaterial;
    Ray ray;
    bool atVertex = true;  // else behind glass
    bool first = true;     // no lobe has reflected the ray yet
    for (uint step = 0u; step < maxSteps; ++step) {
        if (atVertex) {
            if (looksForEmitters(bake)) {
                float metres;
                found.direct += throughput * lightOfEmitter(bake, vertex.lobes, vertex.origin, vertex.normal, vertex.toViewer,
                                                            numbers.pick, numbers.onEmitter, metres, counts);
                if (first) found.lamp = min(found.lamp, metres);
            }
            if (kHasShine != 0u && !first && hasSun(bake, vertex.normal)) {
                vec3 value = evaluateLobes(vertex.lobes, vertex.normal, vertex.toViewer, -bake.sunDirection).value;
                if (maxOf(value) > 0.0) found.direct += throughput * value * sunAt(bake, vertex.origin, counts);
            }
            vec3 direction = sampleLobes(vertex.lobes, vertex.normal, vertex.toViewer, numbers.direction, 0.5);
            Scattering s = evaluateLobes(vertex.lobes, vertex.normal, vertex.toViewer, direction);
            if (maxOf(s.value) <= 0.0) return found;
            throughput *= s.value / s.pdf;
            if (!first && step >= kRouletteBounce) {
                float survival = min(maxOf(throughput), 0.95);
                if (rayRandom() >= survival) return found;
                throughput /= survival;
            }
            ray = Ray(vertex.origin, kInfinity, direction, 0.0);
            pdf = s.pdf;
            travelled = 0.0;
            lastGlass = kNoMaterial;
        }
        Hit hit = castRay(scene, ray, counts);
        if (hit.instance == kNoInstance) {
            found.direct += throughput * skyRadiance(bake, ray.direction);
            return found;
        }
        Surface surface = surfaceOf(scene, ray, hit);
        MaterialRecord material = materialOf(scene, surface);
        atVertex = false;
        if (kHasGlass != 0u && letsThrough(material) &&
            passGlass(scene, ray, throughput, pdf, travelled, lastGlass, hit, surface, material))
            continue;
        if (surface.face == kFaceInside && step == 0u) {  // another instance covers the point
            found.counts = false;
            return found;
        }
        travelled += hit.t;
        vec3 toViewer = -ray.direction;
        if (material.emissionStrength > 0.0) {
            vec3 emission = emissionOf(material);
            float weight = weightOfEmission(bake, pdf, travelled, emission, dot(surface.normal, toViewer));
            found.direct += throughput * emission * weight;
            if (first) found.lamp = min(found.lamp, travelled);
        }
        Lobes lobes = lobesOf(material, albedoOf(scene, surface), surface.normal, toViewer);
        if (kHasShine == 0u || lobes.pick <= 0.0 || rayRandom() >= lobes.pick) {
            found.weight = throughput * lobes.diffuse / (1.0 - lobes.pick);
            found.face = faceOfHit(scene, ray, hit);
            return found;
        }
        throughput /= lobes.pick;
        lobes.diffuse = vec3(0.0);
        lobes.pick = 1.0;
        vertex = Vertex(startOf(surface), surface.normal, toViewer, lobes);
        numbers = randomNumbers();
        atVertex = true;
        first = false;
    }
    return found;
}

// Ray `number` of a value.
Found gather(BakeScene bake, FacePlane plane, FacePart part, uint key, uint number, uint maxSteps, inout RayCounts counts) {
    Lobes white = Lobes(vec3(1.0), vec3(0.0), 0.0, 1.0, 0.0);
    vec3 origin = pointOf(plane, part, sobolPair(joinHash(key, kPointNumbers), number));
    rayState = joinHash(joinHash(key, kStepNumbers), number);
    VertexNumbers numbers = VertexNumbers(sobolPair(joinHash(key, kPickNumbers), number).x,
                                          sobolPair(joinHash(key, kEmitterNumbers), number),
                                          sobolPair(joinHash(key, kDirectionNumbers), number));
    return followRay(bake, Vertex(origin, plane.normal, plane.normal, white), numbers, maxSteps, counts);
}

uint keyOf(BakeScene bake, FacePart part) {
    uint key = joinHash(joinHash(bake.seedLow, bake.seedHigh), part.face);
    if (kMakesLinks != 0u) return joinHash(key, 0x80000000u);
    return part.level == 0u ? key : joinHash(key, part.level << 8 | part.part);
}

shared float nearestLamps[kFaceGroupSize];

void main() {
    FaceBake faces = FaceBakes(push.bake).bake;
    BakeScene bake = BakeScenes(faces.scene).at[0];
    uint slot = gl_LocalInvocationIndex / kFaceLanes;
    uint lane = gl_LocalInvocationIndex % kFaceLanes;
    uint place = faceGroup() * kFaceGroupValues + slot;
    uint value = push.first + place;
    bool works = place < push.count;
    if (kMakesLinks == 0u && works) works = FaceWords(faces.goals).at[value] > push.firstBatch;
    FacePart part = FacePart(0u, 0u, 0u);
    FacePlane plane;
    if (works) {
        part = partOfValue(faces, value);
        plane = planeOf(faces, Scene(bake.scene), FaceRecords(faces.faces).at[part.face]);
    }
    uint key = keyOf(bake, part);
    RayCounts counts = RayCounts(0u, TraceStatistics(0u, 0u));
    vec4 sum = vec4(0.0);
    vec4 quarters = vec4(0.0);
    float lamp = kInfinity;
    if (works && kMakesLinks == 0u && push.firstBatch != 0u) {
        sum = FaceVectors(faces.sums).at[value];
        quarters = FaceVectors(faces.quarters).at[value];
    }
    for (uint batch = push.firstBatch; batch < push.batchEnd; ++batch) {
        vec4 mine = vec4(0.0);
        vec4 mineByQuarter = vec4(0.0);
        for (uint i = 0u; i < kFaceBatchRays / kFaceLanes && works; ++i) {
            uint number = batch * kFaceBatchRays + i * kFaceLanes + lane;
            Found found = gather(bake, plane, part, key, number, faces.maxSteps, counts);
            if (!found.counts) found.face = kNoFace;
            vec3 light = found.direct;
            if (kMakesLinks != 0u) {
                FaceLinks(faces.links).at[value * faces.linkCount + number] = uvec2(found.face, packRgb9e5(found.weight));
                lamp = min(lamp, found.lamp);
            } else if (found.face != kNoFace) {
                light += found.weight * FaceVectors(faces.light[push.source]).at[found.face].rgb;
            }
            if (found.counts) mine += vec4(light, 1.0);
            if (found.counts) mineByQuarter[i & 3u] += meanOf(light);
        }
        // A value's batches are added one after the other, whichever launch they belong to.
        sum += sumOfLanes(mine);
        if (kMakesLinks == 0u) quarters += sumOfLanes(mineByQuarter);
    }
    if (works) addRays(faces, counts);
    if (kMakesLinks != 0u) {
        nearestLamps[gl_LocalInvocationIndex] = lamp;
        barrier();
        if (works && lane == 0u) {
            for (uint i = 1u; i < kFaceLanes; ++i) lamp = min(lamp, nearestLamps[gl_LocalInvocationIndex + i]);
            FaceVectors(faces.direct).at[value] = vec4(sum.rgb / max(sum.w, 1.0), sum.w > 0.0 ? 1.0 / sum.w : 0.0);
            FaceVectors(faces.sun).at[value].w = lamp / plane.voxelMetres;
        }
    } else if (works && lane == 0u) {
        FaceVectors(faces.sums).at[value] = sum;
        FaceVectors(faces.quarters).at[value] = quarters;
    }
}
