#include "support/reference_picture.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <pfvox/reference_caster.hpp>

namespace pfvox::test {

namespace {

std::uint32_t packed(glm::dvec3 c) {
    const auto byte = [](double v) { return static_cast<std::uint32_t>(std::lround(255.0 * std::clamp(v, 0.0, 1.0))); };
    return byte(c.x) | byte(c.y) << 8 | byte(c.z) << 16 | 0xff000000u;
}

double srgbFromLinear(double c) {
    return c > 0.0031308 ? 1.055 * std::pow(c, 1.0 / 2.4) - 0.055 : 12.92 * c;
}

std::uint32_t pixelOf(const OctreeAsset& asset, const ReferenceHit& hit, viewer::ViewMode mode) {
    if (mode == viewer::ViewMode::Albedo) {
        const glm::u8vec4 c = asset.materials[hit.material].baseColor;
        return packed(glm::dvec3(c) / 255.0);
    }
    // The normal is meant for the screen: the viewer takes the encoding at its end back with a power of 2.2.
    const glm::dvec3 shown = 0.5 + 0.5 * hit.normal;
    return packed({srgbFromLinear(std::pow(shown.x, 2.2)), srgbFromLinear(std::pow(shown.y, 2.2)),
                   srgbFromLinear(std::pow(shown.z, 2.2))});
}

}  // namespace

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
            if (hit) picture.pixels[std::size_t{y} * settings.width + x] = pixelOf(asset, *hit, settings.mode);
        }
    });
    return picture;
}

double differingShare(const viewer::Picture& picture, const viewer::Picture& reference) {
    std::size_t hits = 0;
    std::size_t differing = 0;
    for (std::size_t i = 0; i < reference.pixels.size(); ++i) {
        if (reference.pixels[i] == 0) continue;
        ++hits;
        int apart = 0;
        for (int shift = 0; shift < 24; shift += 8) {
            const auto channel = [&](const viewer::Picture& p) { return static_cast<int>(p.pixels[i] >> shift & 0xffu); };
            apart = std::max(apart, std::abs(channel(picture) - channel(reference)));
        }
        differing += apart > 2 ? 1 : 0;
    }
    return hits == 0 ? 1.0 : static_cast<double>(differing) / static_cast<double>(hits);
}

}  // namespace pfvox::test
