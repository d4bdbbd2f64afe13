// Assets made in the tests themselves: small scenes whose every voxel is known.
#pragma once

#include <cstdint>
#include <functional>
#include <pfvox/octree.hpp>
#include <pfvox/voxel_model.hpp>
#include <string>

namespace pfvox::test {

/// A generator of the same numbers everywhere (splitmix64): the standard distributions differ between
/// libraries.
class Random {
  public:
    explicit Random(std::uint64_t seed) : state_(seed) {}
    std::uint64_t next();
    double uniform(double low, double high);
    int integer(int low, int high);  ///< both ends included
    glm::dvec3 direction();          ///< unit length, uniform on the sphere

  private:
    std::uint64_t state_;
};

Material material(std::uint8_t r, std::uint8_t g, std::uint8_t b, float emissionStrength = 0.0f);

/// Sets every voxel of the box for which materialOf gives one.
void fillBox(VoxelModel& model, const VoxelBox& box,
             const std::function<std::optional<MaterialIndex>(glm::ivec3)>& materialOf);

/// Builds the octrees; fails the running test on an error.
OctreeAsset build(const VoxelAsset& asset);

/// A room with colored walls, a sphere, a lamp and steps: 64 x 40 x 64 voxels of 0.1 m, the front open.
VoxelAsset demoRoom();

/// Random voxels of `materials` materials in a cube of the given edge, every `1 / density`-th set.
VoxelModel randomModel(Random& random, int edge, double density, int materials);

/// Sparse shells and pillars over 600 x 300 x 520 voxels: several regions, top tree of two levels, large
/// leaves.
VoxelModel largeModel(int materials);

}  // namespace pfvox::test
