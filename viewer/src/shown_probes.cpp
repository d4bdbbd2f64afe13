#include "shown_probes.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <pfvox/bake.hpp>
#include <pfvox/face_file.hpp>
#include <system_error>

namespace pfvox::viewer {

namespace fs = std::filesystem;

namespace {

std::string bakeCommand(const fs::path& scene, const fs::path& probes) {
    return fmt::format("probe-bake '{}' -o '{}'", scene.string(), probes.string());
}

bool isThere(const fs::path& file) {
    std::error_code error;
    return fs::exists(file, error);
}

/// Says what to do about a file that is no probe file that this program reads.
Error withRemedy(Error error, const fs::path& file, const fs::path& scene) {
    if (error.file.empty()) error.file = file;
    if (error.code == ErrorCode::FileNotReadable || error.code == ErrorCode::GpuOutOfMemory ||
        error.code == ErrorCode::GpuLost || scene.empty())
        return error;
    // What is something else altogether is not to be written over.
    const fs::path output = file.extension() == ".pf_probe" ? file : probesBeside(scene);
    const char* const joint = error.code == ErrorCode::UnsupportedVersion ? ": " : "; bake it: ";
    error.message += joint + bakeCommand(scene, output);
    return error;
}

std::vector<ShownProbe> listOf(const ProbeFileReader& reader) {
    std::vector<ShownProbe> probes;
    for (std::uint32_t i = reader.info().range.first; i < reader.info().range.end; ++i)
        probes.push_back(
            {.position = reader.info().grid.worldOf(reader.positionOf(i)), .record = reader.record(i)});
    return probes;
}

}  // namespace

fs::path probesBeside(const fs::path& scene) {
    if (scene.empty()) return {};
    return fs::path(scene).replace_extension(".pf_probe");
}

Result<fs::path> sceneBeside(const fs::path& probes) {
    for (const char* const extension : {".toml", ".pf_vox"}) {
        fs::path scene = fs::path(probes).replace_extension(extension);
        if (isThere(scene)) return scene;
    }
    const fs::path stem = probes.stem();
    return tl::make_unexpected(Error{
        .code = ErrorCode::FileNotFound,
        .message =
            fmt::format("probes are shown with their scene, and there is neither '{0}.toml' nor '{0}.pf_vox' "
                        "beside them: pfview scene.toml --probes '{1}'",
                        stem.string(), probes.string()),
        .file = probes});
}

float voxelMetresOf(const LoadedScene& scene) {
    double smallest = std::numeric_limits<double>::infinity();
    for (const PlacedAsset& part : scene.parts) {
        for (int axis = 0; axis < 3; ++axis) {
            const double edge = glm::length(part.worldFromAsset[axis]) * part.asset->source.voxelSizeMetres;
            smallest = std::min(smallest, edge);
        }
    }
    return std::isfinite(smallest) && smallest > 0.0 ? static_cast<float>(smallest) : 0.1f;
}

Result<ShownProbes> openProbes(gpu::Device& device, const fs::path& file, const LoadedScene& scene,
                               const gpu::Scene& gpuScene, const fs::path& sceneFile,
                               Diagnostics& diagnostics) {
    const Result<ProbeFileReader> reader = ProbeFileReader::open(file, Limits{}, diagnostics);
    if (!reader) return tl::make_unexpected(withRemedy(reader.error(), file, sceneFile));
    Result<gpu::GpuProbes> field = gpu::GpuProbes::upload(
        device, *reader, {.voxelMetres = voxelMetresOf(scene), .origin = scene.origin()});
    if (!field) return tl::make_unexpected(withRemedy(field.error(), file, sceneFile));
    ShownProbes shown{.file = file,
                      .info = reader->info(),
                      .probes = listOf(*reader),
                      .ofThisScene = reader->info().sceneHash == sceneContentHash(scene),
                      .field = *std::move(field)};
    if (reader->faces()) {
        Result<FaceValues> light = readFaceValues(*reader, gpuScene);
        if (!light && light.error().code != ErrorCode::BadReference)
            return tl::make_unexpected(withRemedy(light.error(), file, sceneFile));
        if (light) {
            PFVOX_TRY(gpu::GpuFaces, faces, gpu::GpuFaces::upload(device, gpuScene, *light));
            shown.faces = std::move(faces);
            shown.faceInstances = reader->faces()->instances;
        }
    }
    if (!shown.ofThisScene) {
        diagnostics.warn(
            "probes-other-scene",
            fmt::format("'{}' was baked for another state of the scene; used as it is. To bake anew: {}",
                        file.string(), bakeCommand(sceneFile, file)));
    }
    return shown;
}

std::string guessNote(const fs::path& sceneFile) {
    const std::string note = "no probes: indirect light is an approximation from what is near by";
    if (sceneFile.empty()) return note;
    return fmt::format("{}; bake it: {}", note, bakeCommand(sceneFile, probesBeside(sceneFile)));
}

Result<std::optional<ShownProbes>> findProbes(gpu::Device& device, const ProbeRequest& request,
                                              const LoadedScene& scene, const gpu::Scene& gpuScene,
                                              const fs::path& sceneFile, Diagnostics& diagnostics) {
    if (request.none) return std::optional<ShownProbes>{};
    const fs::path file = request.file.empty() ? probesBeside(sceneFile) : request.file;
    if (request.file.empty() && (file.empty() || !isThere(file))) return std::optional<ShownProbes>{};
    PFVOX_TRY(ShownProbes, shown, openProbes(device, file, scene, gpuScene, sceneFile, diagnostics));
    return std::optional<ShownProbes>(std::move(shown));
}

Result<void> checkView(ViewMode mode, const ShownProbes* probes, const fs::path& sceneFile) {
    const ViewEntry& entry = entryOf(mode);
    if (entry.needs == ViewNeeds::Nothing) return {};
    if (probes == nullptr && sceneFile.empty()) {
        return fail(ErrorCode::FileNotFound,
                    fmt::format("the view '{}' shows probes, and there are none; save the scene, "
                                "then probe-bake makes them",
                                entry.name));
    }
    if (probes == nullptr) {
        const fs::path file = probesBeside(sceneFile);
        return tl::make_unexpected(
            Error{.code = ErrorCode::FileNotFound,
                  .message = fmt::format("the view '{}' shows probes, and there are none; bake them: {}",
                                         entry.name, bakeCommand(sceneFile, file)),
                  .file = file});
    }
    if (entry.needs == ViewNeeds::DepthMaps && probes->info.resolution.depth == 0) {
        return tl::make_unexpected(Error{
            .code = ErrorCode::UnsupportedFeature,
            .message =
                fmt::format("the view '{}' shows depth maps, and these probes have none; bake with them: {} "
                            "--profile probes",
                            entry.name, bakeCommand(sceneFile, probes->file)),
            .file = probes->file});
    }
    return {};
}

}  // namespace pfvox::viewer
