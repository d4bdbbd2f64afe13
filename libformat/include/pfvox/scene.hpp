// Scene: which PF_VOX files stand where, under which light, seen by which cameras: scene.toml.
//
//     scene.toml -> [readScene] -> Scene -> [loadScene] -> LoadedScene -> GPU scene, baker, viewer
//     Scene -> [writeScene] -> scene.toml
//
// Every key, its unit, default and range is in docs/scene.md. World units are metres, right-handed, +Y up;
// light is linear RGB. Everything in a file is untrusted. Nothing here is changed by two threads at once; the
// functions may be called from several.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <pfvox/asset.hpp>
#include <pfvox/error.hpp>
#include <pfvox/limits.hpp>
#include <pfvox/math.hpp>
#include <pfvox/octree.hpp>
#include <pfvox/probe_grid.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace pfvox {

/// Parallel light from infinitely far away.
struct Sun {
    glm::dvec3 direction{-0.4, -1.0, -0.3};  ///< where the light travels; any length but zero
    glm::dvec3 irradiance{3.0, 2.9, 2.7};    ///< at normal incidence; all zero = no sun
    bool operator==(const Sun&) const = default;
};

/// Radiance from infinitely far away, by the height of the direction. All three the same = a constant sky.
struct Sky {
    glm::dvec3 zenith{0.30, 0.48, 0.80};   ///< radiance straight up
    glm::dvec3 horizon{0.72, 0.80, 0.88};  ///< radiance
    glm::dvec3 ground{0.24, 0.23, 0.22};   ///< radiance straight down
    bool isConstant() const { return zenith == horizon && horizon == ground; }
    bool operator==(const Sky&) const = default;
};

/// What a scene says about its probe grid; what it leaves out is fitted to the models (fitProbeGrid).
struct ProbeGridRequest {
    std::optional<glm::dvec3> position;    ///< of probe (0, 0, 0)
    std::optional<glm::dvec3> stepMetres;  ///< from probe to probe along each axis
    std::optional<glm::uvec3> count;       ///< along x, y, z
    glm::uvec3 proximityCells{64};         ///< cells of the proximity grid over the space of the probes
    bool operator==(const ProbeGridRequest&) const = default;
};

/// A PF_VOX file and where it stands. At most one of cubeEdgeMetres and metresPerVoxel is set; without both
/// the file keeps its own voxel size.
struct SceneModel {
    std::string path;                 ///< as written, UTF-8; relative paths count from the scene file
    std::string name = {};            ///< unique, or empty
    glm::dvec3 translateMetres{0.0};  ///< world space
    glm::dvec3 rotateRadians{0.0};    ///< about x, then y, then z, the axes fixed: R = Rz Ry Rx
    std::optional<glm::dvec3> cubeEdgeMetres;  ///< scaleVec: world edges of the file's octree cube
    std::optional<double> metresPerVoxel;      ///< edge of a voxel; default: the file's
    bool visible = true;                       ///< false: not loaded
    bool operator==(const SceneModel&) const = default;
};
/// What a scene.toml says.
struct Scene {
    ProbeGridRequest probes;
    Sun sun;
    Sky sky;
    std::vector<Camera> cameras;
    std::vector<SceneModel> models;  ///< in the order of the file
    bool operator==(const Scene&) const = default;
};

inline constexpr std::uint64_t kMaxSceneBytes = 16 << 20;
inline constexpr std::uint32_t kMaxProbesPerAxis = 1024;
inline constexpr std::uint32_t kMaxProbes = 1u << 20;

// ---- The file --------------------------------------------------------------------------------------------

/// Reads the text of a scene. `file` is used for messages only.
///
/// Errors, each with file, line and column: BadStructure (not TOML, nested too deeply), BadValue (wrong type,
/// length or range, NaN, a transform that cannot be inverted, a missing key), LimitExceeded (kMaxSceneBytes,
/// Limits::maxModels for models and for cameras). When several values are wrong, the message lists the first
/// ten. Diagnostics, with line and column: scene-unknown-key, scene-duplicate-camera; scene-more-warnings
/// after the first hundred.
Result<Scene> parseScene(std::string_view text, const std::filesystem::path& file, const Limits& limits,
                         Diagnostics& diagnostics);

/// parseScene on a file. Further errors: FileNotFound, FileNotReadable.
Result<Scene> readScene(const std::filesystem::path& file, const Limits& limits, Diagnostics& diagnostics);

/// The canonical text: one spelling for one scene; parseScene gives the same Scene back. Comments and layout
/// of the file that a scene was read from are not in it.
std::string sceneText(const Scene& scene);

/// Writes the canonical text, complete or not at all. Errors: FileNotWritable; those of parseScene when the
/// scene holds what no file may hold.
Result<void> writeScene(const std::filesystem::path& file, const Scene& scene);

/// A model while its path is being replaced.
struct ModelPathUse {
    const SceneModel& model;  ///< of the scene
    std::string place;        ///< of the path in the file: "line 12, column 8"
};
/// The new path of a model; nothing = leave the text as it is.
using NewModelPath = std::function<std::optional<std::string>(const ModelPathUse&)>;

/// The text with other model paths and else unchanged: comments, layout and unknown keys stay. Errors and
/// diagnostics: those of parseScene.
Result<std::string> withModelPaths(std::string_view text, const std::filesystem::path& file,
                                   const Limits& limits, Diagnostics& diagnostics,
                                   const NewModelPath& newPath);

// ---- Where things stand ----------------------------------------------------------------------------------

/// The cube that scaleVec gives the size of: the smallest one of 2^depth voxels that holds the content of all
/// visible instances of a file, its lower corner at that of the content. In voxels of the file's voxel size.
struct SourceCube {
    glm::dvec3 minVoxels{0.0};  ///< lower corner
    std::uint32_t depth = 0;    ///< edge = 2^depth
    double edgeVoxels() const;  ///< 2^depth
};
SourceCube sourceCube(const OctreeAsset& asset);  ///< Of a file without content: depth 0.

/// From the file's cube, as [0, 1]^3, to the world: T * S * R * translate(sourceMin / 2^depth).
Affine worldFromCube(const SceneModel& model, const OctreeAsset& asset);

/// From the file's metres to the world, so that
/// compose(worldFromAsset(m, asset), instance.worldFromModel) places an instance.
Affine worldFromAsset(const SceneModel& model, const OctreeAsset& asset);

/// A box in the world, in metres. Empty when min > max.
struct WorldBounds {
    glm::dvec3 min{std::numeric_limits<double>::infinity()};   ///< metres
    glm::dvec3 max{-std::numeric_limits<double>::infinity()};  ///< metres
    bool empty() const { return min.x > max.x || min.y > max.y || min.z > max.z; }
    void include(const glm::dvec3& point);
};

/// Box of all visible instances.
WorldBounds boundsOf(const OctreeAsset& asset, const Affine& worldFromAsset = identityAffine());

/// Where single precision counts from: the origin of the world for all scenes that stand near it, else a
/// point near the middle of the box, in multiples of 256 m. A float tells 1/16 m apart a thousand kilometers
/// from its origin.
glm::dvec3 frameOrigin(const WorldBounds& bounds);

/// Fills what the request leaves out so that the grid encloses the box; with nothing given, the longest edge
/// of the box has nine probes. Errors: LimitExceeded (kMaxProbesPerAxis, kMaxProbes). Diagnostics: the note
/// scene-grid-smaller when the grid does not enclose the box, unless all of it was given.
Result<ProbeGrid> fitProbeGrid(const ProbeGridRequest& request, const WorldBounds& bounds,
                               Diagnostics& diagnostics);

// ---- With its assets -------------------------------------------------------------------------------------

/// A visible model with its asset.
struct PlacedAsset {
    std::shared_ptr<const OctreeAsset> asset;  ///< shared by all models of one file
    Affine worldFromAsset = identityAffine();  ///< to world space, metres
    std::size_t model = 0;                     ///< index into Scene::models
};
/// A scene with the models that it names.
struct LoadedScene {
    Scene scene;
    std::vector<PlacedAsset> parts;  ///< in the order of Scene::models; invisible ones are not loaded
    WorldBounds bounds;
    ProbeGrid probes;  ///< as asked for, or fitted

    /// What devices count from: frameOrigin() of the bounds.
    const glm::dvec3& origin() const { return probes.origin; }
};

/// Reads a scene (.toml) and every PF_VOX file that its visible models name, each file once. Any other file
/// is read as PF_VOX: it stands at the origin with its own voxel size and cameras, under the default sun and
/// sky.
///
/// Errors: those of readScene, loadPfVox and fitProbeGrid. A missing file is FileNotFound with its place in
/// the scene; for a source instead of a PF_VOX file the message names the command that converts it.
Result<LoadedScene> loadScene(const std::filesystem::path& file, const Limits& limits,
                              Diagnostics& diagnostics);

}  // namespace pfvox
