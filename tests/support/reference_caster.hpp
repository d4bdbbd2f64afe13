// ReferenceCaster: what a ray meets in an octree asset, found in the most obvious way. It is the oracle of
// the fast traversals and shares no code with them.
//
//     OctreeAsset -> [ReferenceCaster] -> ReferenceHit
//
// Double precision; every child of a node whose box the ray meets is visited, the nearest leaf wins. Slow:
// for tests. Threading: a caster may be used by several threads. It keeps pointers into the asset, which must
// outlive it.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <pfvox/math.hpp>
#include <pfvox/octree.hpp>
#include <vector>

namespace pfvox {

/// The face of a voxel through which a ray came in, by its outward normal in the model.
enum class Face : std::uint8_t { MinusX, PlusX, MinusY, PlusY, MinusZ, PlusZ, Inside };

/// In the world, in metres. The direction has any length but zero; t counts in its lengths.
struct ReferenceRay {
    glm::dvec3 origin{0.0};                                 ///< metres
    glm::dvec3 direction{0.0, 0.0, -1.0};                   ///< any length but 0
    double tMax = std::numeric_limits<double>::infinity();  ///< in lengths of the direction
};
/// The first surface on a ray.
struct ReferenceHit {
    double t = 0.0;              ///< 0 when the ray starts in a solid voxel
    std::uint32_t instance = 0;  ///< index into OctreeAsset::instances
    glm::ivec3 voxel{0};         ///< in the model
    Face face = Face::Inside;    ///< Inside: the ray starts in the voxel
    glm::dvec3 normal{0.0};      ///< in the world, unit length, towards the ray; zero for Face::Inside
    MaterialIndex material = 0;  ///< of the asset
};
/// Casts rays the obvious way, in double precision: the oracle. Holds references; thread-safe.
class ReferenceCaster {
  public:
    /// Instances that are hidden, on a hidden layer, or of a transform without inverse are left out.
    explicit ReferenceCaster(const OctreeAsset& asset);

    /// The nearest hit with t in [0, tMax]. A voxel counts when the ray's span in its closed box is not
    /// empty.
    std::optional<ReferenceHit> cast(const ReferenceRay& ray) const;

  private:
    struct Placed {
        std::uint32_t instance = 0;
        const OctreeModel* model = nullptr;
        Affine modelFromWorld = identityAffine();
    };
    std::vector<Placed> placed_;
};

}  // namespace pfvox
