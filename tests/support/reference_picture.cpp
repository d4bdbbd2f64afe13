#include "support/reference_picture.hpp"
#include "support/reference_caster.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "shared/color.glsl.h"

namespace pfvox::test {

namespace {

std::uint32_t packed(glm::dvec3 c) {
    const auto byte = [](double v) {
        return static_cast<std::uint32_t>(std::lround(255.0 * std::clamp(v, 0.0, 1.0)));
    };
    return byte(c.x) | byte(c.y) << 8 | byte(c.z) << 16 | 0xff000000u;
}

/// Of the octree's leaf that a voxel lies in: the largest aligned cube of one material.
int leafLog2(const OctreeModel& model, glm::ivec3 voxel) {
    const auto isUniform = [&](int log2) {
        const int edge = 1 << log2;
        const glm::ivec3 corner = model.originVoxels + (voxel - model.originVoxels) / edge * edge;
        const auto first = model.at(corner);
        for (int i = 0; i < edge * edge * edge; ++i)
            if (model.at(corner + glm::ivec3(i % edge, i / edge % edge, i / edge / edge)) != first)
                return false;
        return true;
    };
    int log2 = 0;
    while (log2 < static_cast<int>(model.depth) && isUniform(log2 + 1)) ++log2;
    return log2;
}

glm::dvec3 indexColor(std::uint32_t index) {
    const auto mixed = [](std::uint32_t x) {
        x = (x ^ x >> 16) * 0x7feb352du;
        x = (x ^ x >> 15) * 0x846ca68bu;
        return x ^ x >> 16;
    };
    const double value = 0.55 + 0.45 * (mixed(index) & 0xffffu) / 65536.0;
    const glm::dvec3 hue = glm::fract(index * 0.61803399) + glm::dvec3(0.0, 0.33, 0.67);
    return value * (0.5 + 0.5 * glm::cos(2.0 * std::numbers::pi * hue));
}

std::uint32_t pixelOf(const OctreeAsset& asset, const ReferenceHit& hit, viewer::ViewMode mode) {
    if (mode == viewer::ViewMode::Albedo)
        return packed(glm::dvec3(asset.materials[hit.material].baseColor) / 255.0);
    if (mode == viewer::ViewMode::Material) return packed(indexColor(hit.material));
    if (mode == viewer::ViewMode::Depth) {
        const OctreeModel& model = asset.models[asset.instances[hit.instance].model];
        return displayed(heatColor(1.0 - leafLog2(model, hit.voxel) / 7.0));
    }
    return packed(0.5 + 0.5 * hit.normal);
}

}  // namespace

std::uint32_t displayed(const glm::dvec3& linear) {
    return packed(shared::srgbFromLinear(linear));
}

glm::dvec3 heatColor(double x) {
    x = std::clamp(x, 0.0, 1.0);
    const auto step = [&](double low, double high) { return glm::smoothstep(low, high, x); };
    const glm::dvec3 cold =
        glm::mix(glm::dvec3(0.01, 0.01, 0.10), glm::dvec3(0.02, 0.35, 0.20), step(0.0, 0.35));
    const glm::dvec3 warm =
        glm::mix(glm::dvec3(0.90, 0.75, 0.05), glm::dvec3(0.85, 0.05, 0.02), step(0.5, 0.85));
    return glm::mix(glm::mix(cold, warm, step(0.25, 0.6)), glm::dvec3(1.0), step(0.85, 1.0));
}

int channelsApart(std::uint32_t a, std::uint32_t b) {
    int apart = 0;
    for (int shift = 0; shift < 24; shift += 8)
        apart = std::max(
            apart, std::abs(static_cast<int>(a >> shift & 0xffu) - static_cast<int>(b >> shift & 0xffu)));
    return apart;
}

viewer::Picture referencePicture(const OctreeAsset& asset, const viewer::ViewCamera& camera,
                                 const viewer::PictureSettings& settings) {
    const ReferenceCaster caster(asset);
    const viewer::CameraFrame frame = viewer::frameOf(camera);
    const double tanY = std::tan(glm::radians(0.5 * camera.fovYDegrees));
    const double tanX = tanY * settings.width / settings.height;
    viewer::Picture picture{.width = settings.width, .height = settings.height, .pixels = {}};
    picture.pixels.resize(std::size_t{settings.width} * settings.height);
    tbb::parallel_for(std::uint32_t{0}, settings.height, [&](std::uint32_t y) {
        for (std::uint32_t x = 0; x < settings.width; ++x) {
            const double u = (2.0 * x + 1.0) / settings.width - 1.0;
            const double v = 1.0 - (2.0 * y + 1.0) / settings.height;
            const glm::dvec3 direction = frame.forward + u * tanX * frame.right + v * tanY * frame.up;
            const auto hit = caster.cast({.origin = camera.position, .direction = direction});
            if (hit)
                picture.pixels[std::size_t{y} * settings.width + x] = pixelOf(asset, *hit, settings.mode);
        }
    });
    return picture;
}

double differingFraction(const viewer::Picture& picture, const viewer::Picture& reference) {
    std::size_t hits = 0;
    std::size_t differing = 0;
    for (std::size_t i = 0; i < reference.pixels.size(); ++i) {
        if (reference.pixels[i] == 0) continue;
        ++hits;
        differing += channelsApart(picture.pixels[i], reference.pixels[i]) > 2 ? 1u : 0u;
    }
    return hits == 0 ? 1.0 : static_cast<double>(differing) / static_cast<double>(hits);
}

}  // namespace pfvox::test
