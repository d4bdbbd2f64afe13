// Asset: what a source file or a PF_VOX file holds beside the voxels: materials, instances, layers, cameras
// and notes.
//
// Two types share it: VoxelAsset (pfvox/voxel_model.hpp), made by importers, and OctreeAsset
// (pfvox/octree.hpp), made by the builder and by the PF_VOX decoder.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <pfvox/math.hpp>
#include <pfvox/name.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace pfvox {
/// How light leaves a surface.
enum class MaterialType : std::uint8_t {
    Diffuse = 0,
    Metal = 1,
    Glass = 2,
    Emit = 3,
    Plastic = 4,
    Blend = 5,
    Media = 6
};

/// The spelling used in reports and in scene files: "diffuse", "metal", ...
const char* toString(MaterialType type);

/// How a voxel meets light; the meaning of each field is in docs/materials.md. Defaults are those of a source
/// that gives none. The PF_VOX file keeps the [0, 1] values as 16-bit fractions and the others as float32:
/// quantised() gives what a round trip through a file gives.
struct Material {
    glm::u8vec4 baseColor{255, 255, 255, 255};  ///< sRGB encoded; alpha is linear, 255 in nearly all sources
    MaterialType type = MaterialType::Diffuse;  ///< how light leaves it
    float metalness = 0.0f;                     ///< [0, 1]
    float roughness = 1.0f;                     ///< [0, 1]
    float specular = 0.5f;                      ///< [0, 1]
    float indexOfRefraction = 1.5f;             ///< >= 1
    float emissionStrength = 0.0f;              ///< >= 0; radiance = linear base color x strength
    float transparency = 0.0f;                  ///< [0, 1]
    float density = 0.0f;                       ///< >= 0; of media, per voxel edge
    float phase = 0.0f;                         ///< Henyey-Greenstein g of media, [-1, 1]
    Name name = {};                             ///< of the source, if it has names

    bool operator==(const Material&) const = default;
};
/// What a PF_VOX file keeps of a number.
enum class Precision : std::uint8_t { Unorm16, Snorm16, Float };

/// A number of a material in every form in which somebody meets it. Equality of materials, rounding, content
/// hashes, JSON and the metadata of OpenVDB files come from this table.
struct MaterialField {
    std::string_view name;  ///< in JSON
    std::string_view key;   ///< in metadata of .vdb files
    float Material::*value;
    Precision precision;
    float least;
    float most;
};
inline constexpr std::array kMaterialFields{
    MaterialField{"metalness", "metalness", &Material::metalness, Precision::Unorm16, 0.0f, 1.0f},
    MaterialField{"roughness", "roughness", &Material::roughness, Precision::Unorm16, 0.0f, 1.0f},
    MaterialField{"specular", "specular", &Material::specular, Precision::Unorm16, 0.0f, 1.0f},
    MaterialField{"indexOfRefraction", "ior", &Material::indexOfRefraction, Precision::Float, 1.0f,
                  std::numeric_limits<float>::max()},
    MaterialField{"emissionStrength", "emission", &Material::emissionStrength, Precision::Float, 0.0f,
                  std::numeric_limits<float>::max()},
    MaterialField{"transparency", "transparency", &Material::transparency, Precision::Unorm16, 0.0f, 1.0f},
    MaterialField{"density", "density", &Material::density, Precision::Float, 0.0f,
                  std::numeric_limits<float>::max()},
    MaterialField{"phase", "phase", &Material::phase, Precision::Snorm16, -1.0f, 1.0f}};

/// Rounded to what a PF_VOX file can hold.
Material quantised(const Material& material);

/// Whether nothing can be seen through a voxel of this material: neither glass nor media, no transparency,
/// full alpha. Where in doubt it is not opaque, so that nothing behind it is taken for hidden.
bool isOpaque(const Material& material);

/// Whether light goes through a voxel of this material in a straight line, as glass; else the voxel stops it,
/// whatever its alpha. As shaders/material.glsl says.
bool letsThrough(const Material& material);

/// One placement of a model. Mirrors (negative determinant) are allowed: MagicaVoxel files contain them.
struct Instance {
    std::uint32_t model = 0;                   ///< index into the asset's models
    Affine worldFromModel = identityAffine();  ///< voxel units of the model to metres
    Name name = {};                            ///< of the source; need not be unique
    std::int32_t layer = -1;                   ///< index into the asset's layers, -1 = none
    bool hidden = false;                       ///< it or its layer is hidden
};
/// A layer of the source.
struct Layer {
    Name name = {};       ///< of the source
    bool hidden = false;  ///< with all of its instances
    bool operator==(const Layer&) const = default;
};

/// A camera that the source file stored, in metres and degrees. A PF_VOX file keeps it as float32.
struct Camera {
    std::string name = {};              ///< unique within a scene
    glm::dvec3 position{0.0};           ///< metres
    glm::dvec3 target{0.0, 0.0, -1.0};  ///< metres; not the position
    double fovYDegrees = 45.0;          ///< 1 to 179; in a scene file at most 170
    bool operator==(const Camera&) const = default;
};

/// Where an asset comes from. Holds nothing of the run: no path, time or user.
struct SourceInfo {
    Name format;                   ///< "vox", "svx", "vdb", ...
    double voxelSizeMetres = 1.0;  ///< edge of one voxel in the world, > 0
    std::vector<Name> notes;       ///< what the source file says about itself
};

/// Everything but the voxels.
struct AssetInfo {
    std::vector<Material> materials;  ///< what voxels refer to by index
    std::vector<Instance> instances;  ///< models in their places
    std::vector<Layer> layers;        ///< what instances refer to by index
    std::vector<Camera> cameras;      ///< of the source
    SourceInfo source;                ///< where it came from
    bool hollowed = false;            ///< hidden voxels took another material (pfvox/hollow.hpp)
};

/// Whether the instance is hidden itself or lies on a hidden layer.
bool isHidden(const AssetInfo& asset, const Instance& instance);

}  // namespace pfvox
