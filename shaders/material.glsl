// What materials mean for light (docs/materials.md): the one place for baker and viewer. Expects octree_trace.glsl.
//
//     MaterialRecord -> lobesOf -> evaluate / sample     Lambert and GGX
//                    -> lets light through (glass)       glassReflectance, glassTransmittance
//
// Directions point away from the surface, unit length. Values include the cosine; a white Lambert surface reflects
// cos / pi.
#ifndef PFVOX_MATERIAL_GLSL
#define PFVOX_MATERIAL_GLSL

const float kPi = 3.14159265;
// pfvox::MaterialType
const uint kMaterialMetal = 1u;
const uint kMaterialGlass = 2u;
const uint kMaterialPlastic = 4u;
const uint kMaterialBlend = 5u;
const uint kMaterialMedia = 6u;
// Sharper lobes are widened to this: light that has been scattered before shows no sharper one, but its noise.
const float kMinRoughness = 0.2;

vec3 emissionOf(MaterialRecord material) { return material.albedo * material.emissionStrength; }
float meanOf(vec3 c) { return (c.r + c.g + c.b) / 3.0; }

// ---- Frames and cosines ----

// From a frame about a unit normal (Duff et al. 2017, "Building an Orthonormal Basis, Revisited").
void frameAbout(vec3 n, out vec3 tangent, out vec3 bitangent) {
    float s = n.z >= 0.0 ? 1.0 : -1.0;
    float a = -1.0 / (s + n.z);
    float b = n.x * n.y * a;
    tangent = vec3(1.0 + s * n.x * n.x * a, s * b, -s * n.x);
    bitangent = vec3(b, s + n.y * n.y * a, -n.y);
}

vec3 inFrame(vec3 d, vec3 n) {
    vec3 tangent, bitangent;
    frameAbout(n, tangent, bitangent);
    return d.x * tangent + d.y * bitangent + d.z * n;
}

// About +z, density cos / pi.
vec3 cosineDirection(vec2 u) {
    float radius = sqrt(u.x);
    float angle = 2.0 * kPi * u.y;
    return vec3(radius * cos(angle), radius * sin(angle), sqrt(max(1.0 - u.x, 1e-7)));
}

// ---- Fresnel (Schlick) ----

float normalReflectance(float indexOfRefraction) {
    float r = (indexOfRefraction - 1.0) / (indexOfRefraction + 1.0);
    return r * r;
}
float schlickWeight(float cosine) {
    float m = clamp(1.0 - cosine, 0.0, 1.0);
    return m * m * m * m * m;
}
float clearReflectance(MaterialRecord material, float cosine) {
    float f0 = min(normalReflectance(material.indexOfRefraction) * 2.0 * material.specular, 1.0);
    return mix(f0, 1.0, schlickWeight(cosine) * float(f0 > 0.0));
}

// ---- Glass: light goes through in a straight line ----

bool letsThrough(MaterialRecord material) {
    bool glass = material.type == kMaterialGlass || material.type == kMaterialMedia || material.type == kMaterialBlend;
    return glass && material.transparency > 0.0 && material.emissionStrength == 0.0;
}
float glassReflectance(MaterialRecord material, float cosine) {
    float f0 = normalReflectance(material.indexOfRefraction);
    return mix(f0, 1.0, schlickWeight(cosine) * float(f0 > 0.0));
}
// Fraction of what is not reflected that goes on, by color; the rest is scattered by a Lambert surface.
vec3 glassTint(MaterialRecord material) { return material.transparency * material.albedo; }

// ---- Everything else: a Lambert lobe and a GGX lobe ----

struct Lobes {
    vec3 diffuse;     // albedo of the Lambert lobe
    vec3 specular0;   // reflectance of the GGX lobe at normal incidence
    float specular;   // factor on that lobe
    float alpha;
    float pick;       // probability of sampling the GGX lobe
};

Lobes lobesOf(MaterialRecord material, vec3 albedo, vec3 normal, vec3 toViewer) {
    Lobes lobes = Lobes(albedo, vec3(0.0), 0.0, 1.0, 0.0);
    float roughness = max(material.roughness, kMinRoughness);
    lobes.alpha = roughness * roughness;
    float cosine = max(dot(normal, toViewer), 0.0);
    if (material.emissionStrength > 0.0) return lobes;
    if (material.type == kMaterialMetal) {
        lobes.diffuse = (1.0 - material.metalness) * albedo;
        lobes.specular0 = albedo;
        lobes.specular = material.metalness;
    } else if (material.type == kMaterialPlastic) {
        float coat = clearReflectance(material, cosine);
        lobes.diffuse = (1.0 - coat) * albedo;
        lobes.specular0 = vec3(min(normalReflectance(material.indexOfRefraction) * 2.0 * material.specular, 1.0));
        lobes.specular = 1.0;
    } else if (letsThrough(material)) {
        lobes.diffuse = (1.0 - material.transparency) * albedo;
    }
    float shine = lobes.specular * meanOf(mix(lobes.specular0, vec3(1.0), schlickWeight(cosine)));
    float sum = shine + meanOf(lobes.diffuse);
    lobes.pick = sum > 0.0 ? shine / sum : 0.0;
    return lobes;
}

float ggxPdf(float cosine, float alpha) {
    float a2 = alpha * alpha;
    float d = cosine * cosine * (a2 - 1.0) + 1.0;
    return a2 / (kPi * d * d);
}
// Smith, of one direction: 2 cos / (cos + sqrt(...)).
float ggxShadow(float cosine, float alpha) {
    float a2 = alpha * alpha;
    return 2.0 * cosine / (cosine + sqrt(a2 + (1.0 - a2) * cosine * cosine));
}

struct Scattering {
    vec3 value;     // of the reflection, times the cosine of the light
    float pdf;  // with which `sampleLobes` gives this direction, per steradian
};

Scattering evaluateLobes(Lobes lobes, vec3 normal, vec3 toViewer, vec3 toLight) {
    float cosLight = dot(normal, toLight);
    float cosViewer = dot(normal, toViewer);
    if (cosLight <= 0.0 || cosViewer <= 0.0) return Scattering(vec3(0.0), 0.0);
    Scattering s = Scattering(lobes.diffuse * (cosLight / kPi), (1.0 - lobes.pick) * cosLight / kPi);
    if (lobes.specular > 0.0) {
        vec3 half_ = normalize(toViewer + toLight);
        float d = ggxPdf(clamp(dot(normal, half_), 0.0, 1.0), lobes.alpha);
        float viewerShadow = ggxShadow(cosViewer, lobes.alpha);
        vec3 fresnel = mix(lobes.specular0, vec3(1.0), schlickWeight(dot(toViewer, half_)));
        s.value += lobes.specular * fresnel * (d * viewerShadow * ggxShadow(cosLight, lobes.alpha) / (4.0 * cosViewer));
        s.pdf += lobes.pick * viewerShadow * d / (4.0 * cosViewer);
    }
    return s;
}

// Visible GGX normals (Heitz 2018, "Sampling the GGX Distribution of Visible Normals").
vec3 visibleNormal(vec3 toViewer, float alpha, vec2 u) {
    vec3 v = normalize(vec3(alpha * toViewer.xy, toViewer.z));
    float squared = dot(v.xy, v.xy);
    vec3 t1 = squared > 0.0 ? vec3(-v.y, v.x, 0.0) * inversesqrt(squared) : vec3(1.0, 0.0, 0.0);
    vec3 t2 = cross(v, t1);
    float r = sqrt(u.x);
    float angle = 2.0 * kPi * u.y;
    float p1 = r * cos(angle);
    float s = 0.5 * (1.0 + v.z);
    float p2 = mix(sqrt(max(1.0 - p1 * p1, 0.0)), r * sin(angle), s);
    vec3 n = p1 * t1 + p2 * t2 + sqrt(max(1.0 - p1 * p1 - p2 * p2, 0.0)) * v;
    return normalize(vec3(alpha * n.xy, max(n.z, 1e-6)));
}

// `choice` picks the lobe. The direction may lie below the surface: its value is 0 then.
vec3 sampleLobes(Lobes lobes, vec3 normal, vec3 toViewer, vec2 u, float choice) {
    if (choice >= lobes.pick) return inFrame(cosineDirection(u), normal);
    vec3 tangent, bitangent;
    frameAbout(normal, tangent, bitangent);
    vec3 local = vec3(dot(toViewer, tangent), dot(toViewer, bitangent), dot(toViewer, normal));
    vec3 m = visibleNormal(local, lobes.alpha, u);
    return reflect(-toViewer, m.x * tangent + m.y * bitangent + m.z * normal);
}

#endif
