// The bytes of a legacy .pf_vox: the octree file of the thesis program, raw memory without magic or checksum
// (docs/import.md, "Legacy PF_VOX", has the field table).
//
//     bytes -> [parseLegacy] -> LegacyFile -> legacy_importer -> VoxelAsset
//
// With M materials, N nodes and L leaf cubes a file has exactly 112 + 60 M + 12 N + 4 L bytes: this sum takes
// the place of a magic number.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <pfvox/error.hpp>
#include <pfvox/limits.hpp>
#include <span>
#include <vector>

namespace pfvox::import::legacy {

inline constexpr std::uint32_t kMaterialBytes = 60;

struct Material {
    std::uint32_t type = 0;
    float metalness = 0.0f;
    float roughness = 0.0f;
    float specular = 0.0f;
    float indexOfRefraction = 0.0f;  ///< 1 when the source had none
    float flux = 0.0f;
    float emission = 0.0f;
    float lowDynamicRange = 0.0f;
    float transparency = 0.0f;
    float alpha = 0.0f;
    float density = 0.0f;
    glm::vec4 color{0.0f};  ///< palette bytes / 255, sRGB encoded
};
static_assert(sizeof(Material) == kMaterialBytes);

struct Node {
    std::uint8_t leafMask = 0;   ///< child slots that are solid cubes; a subset of validMask
    std::uint8_t validMask = 0;  ///< child slots that exist
    std::uint16_t unused = 0;
    std::uint32_t childPointer = 0;  ///< distance in nodes to the first inner child
};
static_assert(sizeof(Node) == 8);

/// A checked file: nodes are breadth first, every node but the root is the child of exactly one earlier node,
/// no leaf lies below `depth`, and every leaf has a material that exists.
struct LegacyFile {
    std::vector<Material> materials;
    std::uint32_t depth = 0;      ///< edge of the octree cube: 2^depth voxels
    glm::ivec3 originSwapped{0};  ///< source position of voxel 0 as (x, z, y)
    glm::vec3 extent{0.0f};       ///< upper corner of the voxels, in octree cubes
    std::vector<Node> nodes;
    std::vector<std::uint32_t> leafMaterials;  ///< in node order, then slot order
};

/// Whether the header can be that of a legacy file: the material array is whole records and the box that
/// follows begins at zero. Needs the file name as a second witness.
bool looksLikeLegacy(std::span<const std::byte> bytes);

/// Reads and checks everything but the values of the materials.
/// Errors, with offset: Truncated, BadValue, BadReference, BadStructure, LimitExceeded (maxMaterials,
/// maxModelDepth).
Result<LegacyFile> parseLegacy(std::span<const std::byte> bytes, const Limits& limits);

}  // namespace pfvox::import::legacy
