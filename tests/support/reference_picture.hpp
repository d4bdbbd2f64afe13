// What a picture must show, by the reference caster: one ray through the middle of each pixel.
#pragma once

#include <pfvox/octree.hpp>

#include "picture.hpp"

namespace pfvox::test {

/// Pixels of the views "normals" and "albedo"; misses are 0 (transparent black), which no picture contains.
viewer::Picture referencePicture(const OctreeAsset& asset, const viewer::ViewCamera& camera,
                                 const viewer::PictureSettings& settings);

/// Share of the pixels that the reference hits and that differ by more than 2 of 255 in some channel.
double differingShare(const viewer::Picture& picture, const viewer::Picture& reference);

}  // namespace pfvox::test
