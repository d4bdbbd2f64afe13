// GpuScene: the voxels of one or more assets in device memory, ready for ray casting.
//
//     OctreeAsset(s) -> [Scene::build] -> device buffers -> shaders/octree_trace.glsl
//
// The layout is that of shaders/shared/scene.glsl.h: a BVH over the instances, and one contiguous block for
// each model, its octree read two levels at a time (docs/decisions/012-wide-tree.md). World units are metres,
// right-handed, +Y up.
#pragma once

#include <memory>
#include <pfvox/error.hpp>
#include <pfvox/face_index.hpp>
#include <pfvox/gpu.hpp>
#include <pfvox/math.hpp>
#include <pfvox/octree.hpp>
#include <pfvox/scene.hpp>
#include <span>
#include <vector>

namespace pfvox::gpu {

namespace detail {
struct FaceTable;
struct SceneRecords;
}  // namespace detail

/// One asset and where it stands. All its visible instances take part.
struct ScenePart {
    const OctreeAsset* asset = nullptr;        ///< must outlive the build
    Affine worldFromAsset = identityAffine();  ///< to world space, metres
};

/// The visible models of a scene file, as Scene::build takes them. They point into `scene`.
std::vector<ScenePart> partsOf(const LoadedScene& scene);

/// A box in the world, in metres. Empty when min > max.
struct WorldBox {
    glm::dvec3 min{std::numeric_limits<double>::infinity()};   ///< metres
    glm::dvec3 max{-std::numeric_limits<double>::infinity()};  ///< metres
    bool empty() const { return min.x > max.x || min.y > max.y || min.z > max.z; }
};

/// What the scene consists of and where its bytes are.
struct SceneStatistics {
    std::uint32_t models = 0;  ///< that a visible instance uses
    std::uint32_t instances = 0;
    std::uint32_t regions = 0;    ///< of all models, each once
    std::uint32_t materials = 0;  ///< of all assets
    std::uint32_t bvhNodes = 0;   ///< of the BVH over regions
    std::uint64_t voxels = 0;     ///< of the models, each counted once
    std::uint64_t nodeBytes = 0;
    std::uint64_t lodBytes = 0;
    std::uint64_t valueBytes = 0;
    std::uint64_t paletteBytes = 0;
    std::uint64_t faceBytes = 0;  ///< of the models' face indices
    std::uint64_t instanceBytes = 0;
    bool hasGlass = false;    ///< materials that let light through
    bool hasMirrors = false;  ///< materials that mirror: metal and plastic
    double buildMs = 0.0;     ///< CPU time of layout, BVH and upload
    std::uint64_t totalBytes() const {
        return nodeBytes + lodBytes + valueBytes + paletteBytes + faceBytes + instanceBytes;
    }
};

class Scene;

/// How a scene is built.
struct SceneOptions {
    /// Models that it has on this device are shared with it instead of laid out and uploaded again, as long
    /// as their materials begin at the same place of the scene's list: moving, adding and copying cost
    /// instances and BVH only. The assets that it was built from must still be there.
    const Scene* known = nullptr;
    /// Of the frame that the device counts in (LoadedScene::origin), so that voxels far away from the world's
    /// are told apart: whoever uploads positions subtracts it in double precision first.
    glm::dvec3 origin{0.0};
    bool faces = false;  ///< number the faces of the models, for light on them (pfvox/face_index.hpp)
};

/// Faces of one instance, and where their values stand in the list of all.
struct PlacedFaces {
    std::uint32_t instance = 0;  ///< its record on the device
    std::uint32_t firstFace = 0;
    std::uint32_t firstMean = 0;  ///< of levels of detail, likewise
    const OctreeModel* model = nullptr;
    const FaceIndex* index = nullptr;          ///< lives as long as the scene
    Affine frameFromModel = identityAffine();  ///< voxels to meters, from the scene's origin
    std::shared_ptr<const detail::FaceTable> table;
};

/// Immutable once built. Keeps its device alive; does not keep the assets.
class Scene {
  public:
    /// Lays the parts out and uploads them. Instances that are hidden, lie on a hidden layer or hold an empty
    /// model are left out; one whose transform cannot be inverted too, with the diagnostic
    /// "scene-flat-instance". Errors: BadReference (instance of a model that does not exist),
    /// UnsupportedFeature (octree deeper than 23 levels), GpuOutOfMemory, GpuLost.
    static Result<Scene> build(Device& device, std::span<const ScenePart> parts, Diagnostics& diagnostics,
                               const SceneOptions& options = {});

    /// Device address of the shared::SceneHeader.
    glm::uvec2 address() const { return table_.addressWords(); }
    const WorldBox& bounds() const { return bounds_; }    ///< world space, metres
    const glm::dvec3& origin() const { return origin_; }  ///< of the device's frame, in the world
    /// As the device counts.
    glm::vec3 onDevice(const glm::dvec3& world) const { return glm::vec3(world - origin_); }
    const SceneStatistics& statistics() const { return statistics_; }
    /// In the order of instances; empty unless faces were asked for.
    const std::vector<PlacedFaces>& faces() const { return faces_; }
    std::uint32_t faceCount() const { return faceCount_; }  ///< of all instances

  private:
    struct PlacedModel;
    using PlacedModels = std::vector<std::shared_ptr<const PlacedModel>>;
    class ModelPlacer;
    static std::uint64_t numberFaces(detail::SceneRecords& records, const PlacedModels& placed,
                                     std::vector<PlacedFaces>& faces);
    Scene(Buffer table, PlacedModels models) : table_(std::move(table)), models_(std::move(models)) {}

    Buffer table_;         ///< header, BVH, instances, models, materials
    PlacedModels models_;  ///< and the blocks of their regions and top trees
    WorldBox bounds_;
    glm::dvec3 origin_{0.0};
    SceneStatistics statistics_;
    std::vector<PlacedFaces> faces_;
    std::uint32_t faceCount_ = 0;
};

}  // namespace pfvox::gpu
