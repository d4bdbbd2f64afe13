#include "bake/emitters.hpp"

#include <cmath>
#include <numeric>
#include <pfvox/octree_walk.hpp>

#include "shared/color.glsl.h"
#include "shared/scene.glsl.h"

namespace pfvox::bake {

namespace {

double meanOf(const glm::dvec3& c) {
    return (c.x + c.y + c.z) / 3.0;
}

shared::EmitterFace faceInWorld(const PlacedModel& placed, const VoxelFace& face,
                                const glm::dvec3& radiance) {
    const glm::dmat3 linear(placed.worldFromModel);
    const int axis = face.axis();
    glm::dvec3 corner(face.voxel);
    if (face.isUpper()) corner[axis] += 1.0;
    glm::dvec3 u = linear[(axis + 1) % 3];
    glm::dvec3 v = linear[(axis + 2) % 3];
    const double determinant = glm::determinant(linear);
    if (face.isUpper() != (determinant > 0.0)) std::swap(u, v);
    const double area = glm::length(glm::cross(u, v));
    return {.corner = glm::vec3(placed.worldFromModel * glm::dvec4(corner, 1.0)),
            .threshold = 1.0f,
            .edgeU = glm::vec3(u),
            .alias = 0,
            .edgeV = glm::vec3(v),
            .offset = static_cast<float>(static_cast<double>(shared::kRayOffsetVoxels) *
                                         std::abs(determinant) / area),
            .radiance = glm::vec3(radiance),
            .reserved = 0.0f};
}

}  // namespace

glm::dvec3 emittedRadiance(const Material& material) {
    return static_cast<double>(material.emissionStrength) *
           shared::linearFromSrgb(glm::dvec3(material.baseColor) / 255.0);
}

void makeAliasTable(std::span<const double> weights, std::span<shared::EmitterFace> faces) {
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    std::vector<double> fraction;
    std::vector<std::uint32_t> small;
    std::vector<std::uint32_t> large;
    for (std::uint32_t i = 0; i < weights.size(); ++i) {
        fraction.push_back(weights[i] / sum * static_cast<double>(weights.size()));
        (fraction[i] < 1.0 ? small : large).push_back(i);
    }
    while (!small.empty() && !large.empty()) {
        const std::uint32_t poor = small.back();
        const std::uint32_t rich = large.back();
        small.pop_back();
        faces[poor].threshold = static_cast<float>(fraction[poor]);
        faces[poor].alias = rich;
        fraction[rich] -= 1.0 - fraction[poor];
        if (fraction[rich] < 1.0) {
            large.pop_back();
            small.push_back(rich);
        }
    }
    // What rounding leaves over is full.
    for (const auto* rest : {&small, &large}) {
        for (const std::uint32_t i : *rest) {
            faces[i].threshold = 1.0f;
            faces[i].alias = i;
        }
    }
}

EmitterList makeEmitters(std::span<const PlacedModel> models) {
    EmitterList list;
    std::vector<double> weights;
    for (const PlacedModel& placed : models) {
        FaceFilter filter;
        std::vector<glm::dvec3> radiances;
        bool any = false;
        for (const Material& material : placed.asset->materials) {
            radiances.push_back(emittedRadiance(material));
            filter.wanted.push_back(meanOf(radiances.back()) > 0.0);
            filter.hides.push_back(isOpaque(material));
            any |= filter.wanted.back();
        }
        if (!any) continue;
        forEachExposedFace(*placed.model, filter, [&](const VoxelFace& face) {
            const glm::dvec3& radiance = radiances[face.material];
            list.faces.push_back(faceInWorld(placed, face, radiance));
            const shared::EmitterFace& made = list.faces.back();
            weights.push_back(glm::length(glm::cross(glm::dvec3(made.edgeU), glm::dvec3(made.edgeV))) *
                              meanOf(radiance));
        });
    }
    if (!weights.empty()) makeAliasTable(weights, list.faces);
    list.power = static_cast<float>(std::accumulate(weights.begin(), weights.end(), 0.0));
    return list;
}

}  // namespace pfvox::bake
