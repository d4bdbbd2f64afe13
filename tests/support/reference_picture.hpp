// What a picture must show, by the reference caster: one ray through the middle of each pixel.
#pragma once

#include <pfvox/octree.hpp>

#include "picture.hpp"

namespace pfvox::test {

/// Pixels of the views "normals", "albedo", "material" and "depth"; misses are 0 (transparent black), which
/// no picture contains.
viewer::Picture referencePicture(const OctreeAsset& asset, const viewer::ViewCamera& camera,
                                 const viewer::PictureSettings& settings);

/// Fraction of the pixels that the reference hits and that differ by more than 2 of 255 in some channel.
double differingFraction(const viewer::Picture& picture, const viewer::Picture& reference);

/// The pixel that shows a linear color.
std::uint32_t displayed(const glm::dvec3& linear);

/// Linear; 0 is cold, 1 hot.
glm::dvec3 heatColor(double x);

/// Largest difference of a channel of two pixels, of 255.
int channelsApart(std::uint32_t a, std::uint32_t b);

}  // namespace pfvox::test
