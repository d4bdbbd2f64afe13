// ShownProbes: the probe field that lights what is shown, and what windows tell about it.
//
//     scene.toml -> probesBeside -> scene.pf_probe -> [openProbes] -> ShownProbes -> pictures
#pragma once

#include <filesystem>
#include <optional>
#include <pfvox/gpu_faces.hpp>
#include <pfvox/gpu_probes.hpp>
#include <pfvox/probe_file.hpp>
#include <pfvox/scene.hpp>
#include <string>
#include <vector>

#include "view_modes.hpp"

namespace pfvox::viewer {

/// One probe of the field, by index in the grid.
struct ShownProbe {
    glm::dvec3 position{0.0};  ///< in the world, metres, offset counted
    ProbeRecord record;
};

struct ShownProbes {
    std::filesystem::path file;
    ProbeFieldInfo info;
    std::vector<ShownProbe> probes;
    bool ofThisScene = true;  ///< baked for the scene as it is now
    gpu::GpuProbes field;
    std::optional<gpu::GpuFaces> faces = {};       ///< light on the faces of the scene that is shown
    std::vector<FaceInstance> faceInstances = {};  ///< whose they are
};

/// "court.toml" -> "court.pf_probe", whether or not it is there; likewise for a .pf_vox file. Of a scene
/// without a file: empty.
std::filesystem::path probesBeside(const std::filesystem::path& scene);

/// The scene or .pf_vox file that a probe file lights: the one beside it with the same stem. Errors:
/// FileNotFound.
Result<std::filesystem::path> sceneBeside(const std::filesystem::path& probes);

/// What the command line says about probes.
struct ProbeRequest {
    std::filesystem::path file;  ///< empty = the one beside the scene, if there is one
    bool none = false;           ///< even if there is one
};

/// Edge of the smallest visible voxel, metres.
float voxelMetresOf(const LoadedScene& scene);

/// Reads a field and uploads it; light on faces as well, where its models are those of `gpuScene`. Probes
/// that were baked for another state of the scene are used with the diagnostic "probes-other-scene", which
/// tells how to bake again. Errors: those of ProbeFileReader::open (what a file is that is no probe file, and
/// how to make one) and GpuProbes::upload, with `file`.
Result<ShownProbes> openProbes(gpu::Device& device, const std::filesystem::path& file,
                               const LoadedScene& scene, const gpu::Scene& gpuScene,
                               const std::filesystem::path& sceneFile, Diagnostics& diagnostics);

/// The probes that a request leads to; nothing when it asks for none, or for those beside the scene and there
/// are none. Errors: those of openProbes.
Result<std::optional<ShownProbes>> findProbes(gpu::Device& device, const ProbeRequest& request,
                                              const LoadedScene& scene, const gpu::Scene& gpuScene,
                                              const std::filesystem::path& sceneFile,
                                              Diagnostics& diagnostics);

/// What is to be told of a picture without probes: that its indirect light is a guess, and the command that
/// bakes.
std::string guessNote(const std::filesystem::path& sceneFile);

/// Whether this view of a scene shows anything. Errors: FileNotFound (no probes), UnsupportedFeature (probes
/// without depth maps); both name the command that makes what is missing.
Result<void> checkView(ViewMode mode, const ShownProbes* probes, const std::filesystem::path& sceneFile);

}  // namespace pfvox::viewer
