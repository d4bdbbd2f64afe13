// Layout of the records of a PF_VOX 1.0 file, byte for byte; header and section table are those of
// container/layout.hpp. docs/format-pf_vox.md says the same in words; change both or none.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "container/layout.hpp"

namespace pfvox::layout {

/// MATL
struct Material {
    std::array<std::uint8_t, 4> baseColor;  ///< sRGB, linear alpha
    std::uint8_t type;
    std::uint8_t reserved;
    std::int16_t phase;       ///< snorm16
    std::uint16_t metalness;  ///< unorm16, as the next three
    std::uint16_t roughness;
    std::uint16_t specular;
    std::uint16_t transparency;
    float indexOfRefraction;
    float emissionStrength;
    float density;
    std::uint32_t name;
};
static_assert(sizeof(Material) == 32 && offsetof(Material, indexOfRefraction) == 16);

/// MODL
struct Model {
    std::uint64_t voxelCount;
    std::array<std::int32_t, 3> origin;
    std::array<std::int32_t, 3> boundsMin;
    std::array<std::int32_t, 3> boundsMax;
    std::uint32_t depth;
    std::uint32_t name;
    std::uint32_t firstRegion;
    std::uint32_t regionCount;
    std::uint32_t topNodeCount;
    std::uint32_t topBranchCount;
    std::uint32_t topFarCount;
    std::array<std::uint32_t, 2> reserved;
};
static_assert(sizeof(Model) == 80 && offsetof(Model, depth) == 44);

/// REGN
struct Region {
    std::array<std::int32_t, 3> origin;
    std::uint32_t depth;
    std::uint32_t nodeCount;
    std::uint32_t branchCount;  ///< nodes with inner children
    std::uint32_t farCount;
    std::uint32_t valueCount;
    std::uint32_t paletteFirst;  ///< first entry in PALT
    std::uint32_t paletteCount;
    std::uint32_t voxelCount;
    std::array<std::uint16_t, 3> boundsMin;  ///< relative to origin
    std::array<std::uint16_t, 3> boundsMax;
    std::array<std::uint32_t, 2> reserved;
};
static_assert(sizeof(Region) == 64 && offsetof(Region, boundsMin) == 44);

/// INST
struct Instance {
    std::array<float, 12> worldFromModel;  ///< three rows of four
    std::uint32_t model;
    std::uint32_t name;
    std::int32_t layer;
    std::uint32_t flags;
};
inline constexpr std::uint32_t kInstanceHidden = 1u << 0;
static_assert(sizeof(Instance) == 64);

/// INSX, one an instance, where INST alone would move one of them by more than kPlaceSlack. Since 1.1.
struct Place {
    std::array<double, 3> translation;  ///< the last column of worldFromModel
};
static_assert(sizeof(Place) == 24);
inline constexpr double kPlaceSlack = 1.0 / 4096.0;  ///< edges of a voxel

/// LAYR
struct Layer {
    std::uint32_t name;
    std::uint32_t flags;
};
inline constexpr std::uint32_t kLayerHidden = 1u << 0;
static_assert(sizeof(Layer) == 8);

/// CAMR
struct Camera {
    std::array<float, 3> position;
    std::array<float, 3> target;
    float fovYDegrees;
    std::uint32_t name;
};
static_assert(sizeof(Camera) == 32);

/// META; `noteCount` u32 name indices follow.
struct Meta {
    double voxelSizeMetres;
    std::uint32_t format;
    std::uint32_t noteCount;
};
static_assert(sizeof(Meta) == 16);

inline constexpr std::uint32_t kMaxRegionDepth = 8;
inline constexpr std::uint32_t kMaxRegionNodes = ((1u << 24) - 1) / 7;  ///< 8^0 + ... + 8^7
inline constexpr std::uint32_t kMaxRegionValues = 1u << 24;
inline constexpr std::uint32_t kMaxPalette = 1u << 16;  ///< what values of 16 bits can name
inline constexpr std::uint32_t kMaxModelDepth = 30;     ///< so that the edge of the cube is an int32
inline constexpr std::uint64_t kMaxLayers = 1u << 20;   ///< cameras, too

}  // namespace pfvox::layout
